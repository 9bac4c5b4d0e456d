"""Whether the motor's encoder kept its zero, from the one turn of a proof."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.across_runs.one_zero import shown_common, zero_between
from rig.core.units import DEG
from rig.model.fourier import FourierSeries
from tests.analysis.synthetic import ARCSEC, PROFILE, TURN, MadeRun, count

N = 50.0
LATE = 8.0 / ARCSEC  # rad: friction of the load winds the gear up one way and the other


def proof(moved_deg: float = 0.0, series: FourierSeries = PROFILE, turn: float = 1.0, seed: int = 1) -> MadeRun:
    """One turn forth and back at 15 rpm, its corners slower, by encoders that count; the zero `moved_deg` on."""
    rate, span, rng = 1000.0, turn * TURN, np.random.default_rng(seed)
    s = np.linspace(0.0, 1.0, int(4.0 * turn * rate))
    way = span * np.interp(s, [0.0, 0.05, 0.95, 1.0], [0.0, 0.03, 0.97, 1.0])
    theta = np.concatenate((np.zeros(500), way, np.full(500, span), span - way, np.zeros(500)))
    late = LATE * np.sign(np.gradient(theta))
    theta_l = theta / N - series.value(theta) - late + 1e-6 * rng.standard_normal(theta.size)
    columns = {
        "t": np.arange(theta.size) / rate,
        "theta_m": count(theta + moved_deg * DEG, 10_000),
        "theta_l": count(theta_l, 900_000),
    }
    return MadeRun(columns, {"procedure": "other", "gear": {"ratio": N}})


def test_a_zero_that_was_kept_is_found_to_have_been() -> None:
    where = zero_between(proof(), PROFILE)
    assert where is not None
    assert abs(where.fitted / DEG) < 1.0
    assert shown_common(where)


@pytest.mark.parametrize("moved", [4.0, -30.0, 90.0, 180.0])
def test_a_zero_that_has_moved_is_found_where_it_is_and_not_taken_for_common(moved: float) -> None:
    where = zero_between(proof(moved), PROFILE)
    assert where is not None
    apart = (where.fitted / DEG - moved + 180.0) % 360.0 - 180.0
    assert abs(apart) < max(4.0 * where.u_fitted / DEG, 0.5)
    assert not shown_common(where)


def test_a_gear_without_an_error_that_stands_out_shows_nothing() -> None:
    silent = FourierSeries((0.0,) * 15, (0.0,) * 15)
    assert not shown_common(zero_between(proof(series=silent), PROFILE))


def test_half_a_turn_or_a_run_that_rests_shows_nothing() -> None:
    assert zero_between(proof(turn=0.5), PROFILE) is None
    still = proof()
    still.columns["theta_m"][:] = 0.0
    assert zero_between(still, PROFILE) is None
