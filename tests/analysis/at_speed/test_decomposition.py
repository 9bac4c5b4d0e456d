"""θ̃ = θ̃_p + θ̃_s: a slow and a fast run made of formulas, with one zero and with different ones."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from rig.analysis import analyse
from rig.analysis.findings.result import Result
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear
from rig.model.linear import transmissibility
from tests.analysis.synthetic import ARCSEC, PROFILE, TURN, MadeRun, count, slow_run, wander

GEAR = Gear(50.0, 1.1e-3, 0.32, 7160.0, 5e-4, 0.5, 2.5e-3, 3.6, PROFILE)
DECLARED = {"J_m": 1.1e-3, "J_l": 0.32, "K": 7160.0, "B_sp": 3.6}
SLOW = slow_run(3, rate=250.0, manifest={"declared": DECLARED, "gear": {"ratio": 50.0}})


def at_speed(omega: float, shift: float = 0.0, seed: int = 5, declared: dict[str, float] = DECLARED) -> MadeRun:
    """60 turns at `omega` rad/s whose θ̃ is the pure one times the linear transmissibility; `shift` rad of the zero."""
    rng = np.random.default_rng(seed)
    dt = 1e-3
    t = np.arange(int(60.5 * TURN / abs(omega) / dt)) * dt
    theta = omega * t + 0.01 * np.sin(3 * t)
    pure = np.asarray(PROFILE.a) - 1j * np.asarray(PROFILE.b)
    z = pure * transmissibility(GEAR, PROFILE.orders, omega)
    error = FourierSeries(tuple(z.real), tuple(-z.imag)).value(theta) + wander(rng, t.size, dt, 0.3, 0.3 / ARCSEC)
    columns = {"t": t, "theta_m": count(theta, 10_000) + shift, "theta_l": count(theta / 50.0 - error, 900_000)}
    base = {"procedure": "constant_torque", "gear": {"ratio": 50.0}, "status": "completed", "declared": declared}
    return MadeRun(columns, base)


def rows(result: Result) -> list[dict[str, Any]]:
    return [dict(r) for r in result.tables["decomposition"]]


def true_flexible(omega: float) -> Any:
    return np.abs((transmissibility(GEAR, PROFILE.orders, omega) - 1.0) * PROFILE.amplitude) * ARCSEC


@pytest.mark.parametrize(
    "omega", [pytest.param(32.5, marks=pytest.mark.slow), -32.5, pytest.param(52.4, marks=pytest.mark.slow)]
)
def test_the_flexible_part_lies_within_its_interval_and_beside_the_prediction(omega: float) -> None:
    found = rows(analyse(at_speed(omega), SLOW))
    truth = true_flexible(omega)
    inside = [r["flexible_lo"] - 0.02 <= true <= r["flexible_hi"] + 0.02 for r, true in zip(found, truth, strict=True)]
    assert sum(inside) >= 13, "95 % of 15 orders"
    for r, true in zip(found, truth, strict=True):
        assert r["predicted"] == pytest.approx(true, abs=0.3 + 0.03 * true)


@pytest.mark.parametrize("shift_deg", [-130.0, pytest.param(178.0, marks=pytest.mark.slow)])
def test_a_different_zero_is_found_and_turned_back(shift_deg: float) -> None:
    result = analyse(at_speed(32.5, np.radians(shift_deg)), SLOW)
    shift = next(e for e in result.estimates if e.name == "alignment_shift")
    assert shift.ci95[0] - 0.05 <= shift_deg <= shift.ci95[1] + 0.05
    assert "different zeros" in next(c for c in result.checks if c.name == "alignment").sentence
    for r, true in list(zip(rows(result), true_flexible(32.5), strict=True))[:8]:
        assert r["flexible"] == pytest.approx(true, abs=max(0.5 * (r["flexible_hi"] - r["flexible_lo"]) * 1.5, 0.3))


@pytest.mark.slow
def test_one_zero_is_recognised_and_nothing_is_turned() -> None:
    result = analyse(at_speed(32.5), SLOW)
    assert "from one zero" in next(c for c in result.checks if c.name == "alignment").sentence


@pytest.mark.slow
def test_without_declared_inertias_the_split_is_made_and_the_prediction_is_missing_and_told() -> None:
    result = analyse(at_speed(12.57, declared={}), SLOW)
    assert all("predicted" not in r for r in rows(result))
    assert any("linear prediction" in sentence for sentence in result.cannot)
    assert rows(result)[1]["flexible"] == pytest.approx(true_flexible(12.57)[1], abs=0.3)


@pytest.mark.slow
def test_a_small_shift_is_no_other_zero_and_is_told() -> None:
    result = analyse(at_speed(32.5, np.radians(3.0)), SLOW)
    check = next(c for c in result.checks if c.name == "alignment")
    assert not check.passed
    assert "encoders read at different times" in check.sentence


@pytest.mark.slow
def test_without_a_slow_run_it_is_said_what_is_needed() -> None:
    assert any("--reference" in sentence for sentence in analyse(at_speed(32.5)).cannot)


@pytest.mark.slow
def test_a_reference_without_a_load_angle_is_no_reference() -> None:
    blind = MadeRun({k: v for k, v in SLOW.columns.items() if k != "theta_l"}, SLOW.manifest)
    result = analyse(at_speed(32.5), blind)
    assert "decomposition" not in result.tables
    assert any("could not be split" in sentence for sentence in result.cannot)
