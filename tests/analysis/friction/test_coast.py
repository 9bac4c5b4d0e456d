"""A coast made of formulas gives back its inertia and friction; a run without coasts says so."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis import analyse
from rig.analysis.friction.coast import Piece, columns, fit_coasts
from tests.analysis.synthetic import Array, MadeRun, count

J, TAU_C, B = 1.228e-3, 0.32, 3.3e-3
OMEGA = 52.36  # rad/s, 500 rpm


def speed(t: Array, omega_0: float, tau_c: float) -> Array:
    return np.asarray((omega_0 + tau_c / B) * np.exp(-B / J * t) - tau_c / B)


def made(repeats: int, seed: int = 0) -> MadeRun:
    """Hold 1.2 s, coast, rest 0.2 s; forward and reverse; friction 1 % different each time; 10 000 counts a turn."""
    rng = np.random.default_rng(seed)
    omega, tau = [np.zeros(200)], [np.zeros(200)]
    for k in range(2 * repeats):
        sign, friction = (-1.0) ** k, TAU_C * (1.0 + 0.01 * rng.standard_normal())
        t = np.arange(400) * 1e-3
        omega += [np.linspace(0, sign * OMEGA, 500), np.full(1200, sign * OMEGA)]
        omega.append(sign * np.maximum(speed(t, OMEGA, friction), 0.0))
        tau += [np.full(500, sign * 0.5), np.full(1200, sign * (friction + B * OMEGA)), np.zeros(400)]
    theta = np.cumsum(np.concatenate(omega)) * 1e-3
    table = {
        "t": np.arange(theta.size) * 1e-3,
        "theta_m": count(theta, 10_000),
        "tau_applied": np.concatenate(tau),
    }
    return MadeRun(table, {"procedure": "coast_down", "gear": {"ratio": 50.0}})


def test_inertia_and_friction_lie_within_their_intervals_and_within_a_few_per_cent() -> None:
    figures = {e.name: e for e in analyse(made(6)).estimates}
    for name, true, within in (
        ("inertia_at_motor", J, 0.03),
        ("coulomb_torque", TAU_C, 0.03),
        ("viscous_friction", B, 0.2),
    ):
        e = figures[name]
        assert e.ci95[0] <= true <= e.ci95[1], name
        assert e.value == pytest.approx(true, rel=within), name


@pytest.mark.slow
@pytest.mark.long
def test_both_directions_differ_by_no_more_than_their_interval_says() -> None:
    held = []
    for seed in range(24):
        figures = {e.name: e for e in analyse(made(4, seed)).estimates}
        low, high = figures["holding_torque_difference"].ci95
        held.append(low <= 0.0 <= high)
        assert 0.0 < high - low < 0.1 * TAU_C
    assert sum(held) >= 19, "24 of 95 %"


@pytest.mark.slow
def test_the_declared_inertia_is_compared_and_a_wrong_one_is_told() -> None:
    right = {"J_m": 1.1e-3, "J_l": 0.32, "K": 7160.0, "B_sp": 3.6}
    for declared, agrees in ((right, True), (right | {"J_l": 0.64}, False)):
        run = made(4)
        run = MadeRun(run.columns, {**run.manifest, "declared": declared})
        check = next(c for c in analyse(run).checks if c.name == "inertia_as_declared")
        assert check.passed is agrees


def test_the_law_without_viscous_friction_is_a_parabola() -> None:
    t = np.linspace(0.0, 0.1, 50)
    assert np.allclose(columns(t, 1e-4, 0j), columns(t, 0.0, 0j), atol=1e-6)


def test_a_common_rate_is_found_where_one_coast_alone_hardly_shows_it() -> None:
    t = np.arange(0.004, 0.12, 1e-3)
    pieces = []
    for k in range(8):
        fine = np.linspace(0.0, 0.12, 12001)
        angle = np.concatenate(([0.0], np.cumsum(speed(fine, OMEGA, TAU_C * (1 + 0.004 * k))[:-1]) * 1e-5))
        pieces.append(Piece(t, count(np.interp(t, fine, angle), 10_000, 1e-4 * k), 1, 0.49))
    coasts, b, u = fit_coasts(pieces, 0j)
    assert b == pytest.approx(B / J, abs=max(3 * u, 0.2))
    assert np.mean([c.omega_0 for c in coasts]) == pytest.approx(OMEGA, rel=0.002)


def test_a_run_without_coasts_is_inconclusive_and_says_what_it_needs() -> None:
    t = np.arange(5000) * 1e-3
    run = MadeRun(
        {"t": t, "theta_m": 30.0 * t, "theta_l": 0.6 * t}, {"procedure": "coast_down", "gear": {"ratio": 50.0}}
    )
    result = analyse(run)
    assert result.verdict == "INCONCLUSIVE"
    assert "0 coasts" in result.sentence
