"""The search on some of the rows: they are the rows that the whole run makes."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.tracing.fit.some import laid_out
from rig.analysis.tracing.runs.smoothing import Smoother

SMOOTHER = Smoother(36.0, 0.004, 2)


def made_from(asked: np.ndarray, n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rows of a signal as the whole piece makes them and as the stretches do, and how many rows of it these take."""
    x = np.cumsum(np.random.default_rng(3).standard_normal(n))
    rows, here, local = laid_out(SMOOTHER, asked, n)
    return SMOOTHER(x)[here], SMOOTHER(x[rows])[local], rows


@pytest.mark.parametrize("n", [4000, 4001])
@pytest.mark.parametrize(
    "wanted", [(0, 300), (5, 6), (1700, 1990), (100, 400, 900, 950, 1500, 1501), (100, 400, 403, 600)], ids=str
)
def test_rows_made_from_stretches_are_those_of_the_whole(n: int, wanted: tuple[int, ...]) -> None:
    asked = np.zeros(SMOOTHER.rows(n), dtype=bool)
    for lo, hi in zip(wanted[::2], wanted[1::2], strict=True):
        asked[lo:hi] = True
    whole, some, rows = made_from(asked, n)
    assert whole.size >= asked.sum()
    np.testing.assert_array_equal(some, whole)
    assert rows.size < SMOOTHER.step * (asked.sum() + 30 * len(wanted))
    assert np.all(np.diff(rows) > 0)


def test_stretches_that_would_touch_are_one() -> None:
    asked = np.zeros(SMOOTHER.rows(4000), dtype=bool)
    asked[100:200] = asked[203:300] = True
    _, here, _ = laid_out(SMOOTHER, asked, 4000)
    assert np.flatnonzero(here).tolist() == list(range(100, 300))


def test_of_a_piece_nothing_is_asked_of_nothing_is_made() -> None:
    rows, here, local = laid_out(SMOOTHER, np.zeros(SMOOTHER.rows(4000), dtype=bool), 4000)
    assert (rows.size, int(here.sum()), local.size) == (0, 0, 0)
