"""The search on some of the rows: they are the rows that the whole run makes."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit import some as module
from rig.analysis.tracing.fit.bank import fill, reach
from rig.analysis.tracing.fit.equations import Equations, Noise
from rig.analysis.tracing.fit.model import design, fit
from rig.analysis.tracing.fit.rows import Rows
from rig.analysis.tracing.fit.some import Bounds, Stretches, laid_out, search_some, some
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.runs.smoothing import Smoother
from rig.model.effects import CATALOGUE
from tests.analysis.tracing.test_expected import RUNS
from tests.analysis.tracing.test_few_channels import reduced

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


def test_a_channel_of_few_rows_of_which_none_is_left_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """A lock test has a dozen rows in the motor's torque, all at one end of it."""
    first, last = np.zeros((2, 100), dtype=bool)
    first[:50], last[88:] = True, True
    left = Stretches(first, (np.arange(50),), np.ones(50, dtype=bool))
    monkeypatch.setattr(module, "stretches", lambda eq, i, share, fewest: left)
    monkeypatch.setattr(Stretches, "recording", lambda self, run: run)
    run: Any = SimpleNamespace(pieces=(SimpleNamespace(t=np.zeros(100)),))

    def rows(keep: np.ndarray) -> Rows:
        n = int(keep.sum())
        return Rows(np.zeros(n), np.ones((n, 1)), (0,), keep, np.zeros(n), np.ones((n, 1)))

    blocks = {(0, "A"): rows(first | last), (0, "M"): rows(last)}
    own = {key: np.ones((r.y.size, 1)) for key, r in blocks.items()}
    noise = Noise({}, {}, dict.fromkeys("AM", 1.0))
    made = some(Equations((run,), blocks, noise, own, {}, dict.fromkeys(blocks, 2.0)), [0])
    assert {key: r.y.size for key, r in made.rows.items()} == {(0, "A"): 50}
    assert made.own.keys() == made.stands_for.keys() == {(0, "A")}


@pytest.mark.slow
def test_what_some_rows_brought_is_fitted_to_all_of_them(
    tmp_path: Path, shared: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`searched.beside` does not fit it once more."""
    monkeypatch.setattr("rig.analysis.tracing.fit.some.SEARCHED", Bounds(5000, 4000, 2000))
    p = prepare(read_campaign(reduced(tmp_path, shared / "cases" / "open-5", RUNS, ())), ())
    runs = p.split.fitted
    covered = reach([p.eq.runs[i] for i in runs])
    rows = some(p.eq, runs).rows
    most = max(sum(r.y.size for (i, channel), r in rows.items() if channel == c and i in runs) for c in "AML")
    assert 3000 < most < 5000
    bank = fill(some(p.eq.afresh(), runs), [CATALOGUE["stribeck_friction"]], runs, covered)
    found = search_some(design(p.eq, (), runs), bank, runs, covered, p.floors)
    assert found.rough
    assert found.names == ("stribeck_friction",)
    d = found.solution.design
    np.testing.assert_array_equal(found.solution.x, fit(design(d.eq, d.terms, runs)).x)
    assert sum(y.size for y in d.y.values()) == sum(p.eq.rows[key].y.size for key in p.eq.of(runs))


def test_ranked_by_few_rows_a_run_in_short_pieces_gives_less_as_well(shared: Path, tmp_path: Path) -> None:
    """Where nothing was repeated runs are cut, some a second at a time."""
    campaign = reduced(tmp_path, shared / "cases" / "open-5", ("slow_ke_1", "speed_60rpm_1"), ())
    p = prepare(read_campaign(campaign), ())
    cut = [i for i in p.split.fitted if len(p.eq.runs[i].pieces) > 1]
    assert cut
    whole, few = (some(p.eq, p.split.fitted, Bounds(10, left, 100)) for left in (10**9, 1000))
    for key in p.eq.of(cut):
        if key[1] in "AML":
            assert few.rows[key].y.size < 0.6 * whole.rows[key].y.size
