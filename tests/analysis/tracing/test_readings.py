"""What columns read in some rows foretell of others: least squares beside the baseline and zeros of the runs."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.tracing.residual.binned import solved
from rig.analysis.tracing.residual.joined import Rest
from rig.analysis.tracing.residual.readings import in_columns, waves

RUNS, ROWS, ORDER = 6, 4000, 3.3


def rest(rng: np.random.Generator, own_zeros: bool) -> Rest:
    angle = np.cumsum(rng.uniform(0.0, 0.05, RUNS * ROWS))
    run = np.repeat(np.arange(RUNS), ROWS)
    way = np.where(run % 2, 1.0, -1.0)  # even within each run: beside its zero nothing is left of it
    z = np.column_stack([np.cos(angle), np.sin(angle), way, np.cos(3 * angle)]) * 40.0
    e = rng.standard_normal(run.size) + 2.0 * np.cos(ORDER * angle) + 0.5 * run
    return Rest(e, run, {"motor_angle": angle}, 0.01, z, np.diag([1.0, 2.0, 0.0, 50.0]), own_zeros)


@pytest.mark.parametrize("own_zeros", [True, False])
def test_sums_over_all_rows_give_what_columns_written_out_do(rng: np.random.Generator, own_zeros: bool) -> None:
    r, fitted = rest(rng, own_zeros), np.arange(RUNS * ROWS) < 4 * ROWS
    columns = np.column_stack([waves(r.at["motor_angle"], ORDER), r.z])
    e, z = r.e.copy(), columns.copy()
    if own_zeros:
        for run in range(4):
            mine = r.run == run
            e[mine], z[mine] = e[mine] - e[mine].mean(), z[mine] - z[mine].mean(0)
    normal = z[fitted].T @ z[fitted]
    normal[2:, 2:] += 4 * ROWS * r.known
    by_hand = z @ solved(normal, z[fitted].T @ e[fitted])
    found = in_columns(lambda rest: waves(rest.at["motor_angle"], ORDER))(r, fitted)
    np.testing.assert_allclose(found, by_hand, atol=1e-4)  # of the way, even within each run, rounding is left


def test_a_row_of_which_a_column_is_not_known_is_not_fitted(rng: np.random.Generator) -> None:
    r, fitted = rest(rng, True), np.arange(RUNS * ROWS) < 4 * ROWS

    def of(unknown: float):  # type: ignore[no-untyped-def]
        wave = waves(r.at["motor_angle"], ORDER)
        wave[: ROWS // 2] = unknown
        return in_columns(lambda _: wave)(r, fitted)

    assert np.isfinite(of(np.nan)).all()
    assert np.abs(of(np.nan)[4 * ROWS :] - of(0.0)[4 * ROWS :]).max() > 0.0  # of zeros they would be
