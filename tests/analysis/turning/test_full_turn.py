"""Lines planted close together are told apart over a whole output turn; transmission accuracy is the makers' figure."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis import analyse
from rig.analysis.findings.result import Estimate, Result
from rig.analysis.turning.accuracy import accuracy
from rig.analysis.turning.full_turn import output_orders
from tests.analysis.synthetic import ARCSEC, PROFILE, TURN, Array, MadeRun, count, wander

N = 50.0


def made(seed: int, planted: dict[float, float], turns: float = 1.0, drift: float = 0.0) -> MadeRun:
    """One direction at 9.6 rpm, 100 Hz, `planted` order → arcsec beside the profile, `drift` arcsec per output turn."""
    rng = np.random.default_rng(seed)
    rate, omega = 100.0, 9.6 * np.pi / 30
    t = np.arange(int((turns * N + 1.5) * TURN / omega * rate)) / rate
    theta = omega * t
    error = PROFILE.value(theta) * ARCSEC + wander(rng, t.size, 1 / rate, 0.3, 0.29)
    for order, amplitude in planted.items():
        error += amplitude * np.cos(order * theta - 0.7)
    error += drift * theta / (TURN * N)
    columns = {"t": t, "theta_m": count(theta, 100_000), "theta_l": count(theta / N - error / ARCSEC, 900_000)}
    return MadeRun(columns, {"procedure": "full_turn", "gear": {"ratio": N, "output": "flexspline"}})


def figure(result: Result, name: str) -> Estimate:
    return next(e for e in result.estimates if e.name == name)


@pytest.mark.slow
def test_planted_lines_lie_within_their_intervals() -> None:
    planted = {0.02: 3.0, 1.02: 0.5, 2.04: 1.5, 4.08: 0.4}
    result = analyse(made(1, planted))
    for order, amplitude in planted.items():
        e = figure(result, f"line_{order:g}")
        assert e.ci95[0] - 0.02 <= amplitude <= e.ci95[1] + 0.02
        assert e.ci95[0] > 0


@pytest.mark.slow
def test_absent_lines_are_told_from_zero_no_more_often_than_chance_allows() -> None:
    resolved = 0
    for seed in range(4):
        plain = analyse(made(seed, {}))
        for order in (0.04, 1.02, 2.04, 4.08):
            e = figure(plain, f"line_{order:g}")
            resolved += e.ci95[0] > 0
            assert e.value < 0.15
    assert resolved <= 3, "5 % of 16 are expected"


@pytest.mark.slow
def test_what_repeats_with_the_output_is_in_the_accuracy_and_not_in_the_paper_s_peak_to_peak() -> None:
    result = analyse(made(3, {0.02: 20.0}))
    maker, paper = figure(result, "transmission_accuracy"), figure(result, "kinematic_error_peak_to_peak")
    assert maker.value == pytest.approx(paper.value + 40.0, abs=1.5)
    assert "not the paper's peak to peak" in result.sentence
    assert "as makers define it" in maker.how


@pytest.mark.slow
def test_the_interval_of_the_accuracy_holds_the_truth_in_nine_of_ten_runs() -> None:
    rng = np.random.default_rng(0)
    theta = np.linspace(0.0, TURN * N, 30_000)

    def true(angle: Array) -> Array:
        return np.asarray(PROFILE.value(angle) * ARCSEC + 3 * np.sin(angle / N + 0.3) + 2 * np.cos(2.04 * angle))

    size = float(np.ptp(true(np.linspace(0.0, TURN * N, 200_001))))
    held = 0
    for _ in range(10):
        noise = wander(rng, theta.size, 313 / theta.size, 0.3, 0.29) + rng.normal(0, 0.4, theta.size)
        found = accuracy(theta, true(theta) + noise, N, 1)
        assert found.value == pytest.approx(size, abs=0.5)
        held += found.low <= size <= found.high
    assert held >= 7


@pytest.mark.slow
def test_two_turns_tell_a_drift_from_an_error_once_per_turn_and_one_turn_says_it_cannot() -> None:
    two = analyse(made(4, {}, turns=2.0, drift=8.0))
    one = analyse(made(4, {}, drift=8.0))
    assert figure(two, "line_0.02").value < 0.3
    assert figure(one, "line_0.02").value > 1.0
    assert any("drift with time looks like" in sentence for sentence in one.cannot)


def test_less_than_a_turn_has_no_accuracy_and_says_what_it_needs() -> None:
    result = analyse(made(5, {}, turns=0.5))
    assert not any(e.name == "transmission_accuracy" for e in result.estimates)
    assert any("needs 50 turns" in sentence for sentence in result.cannot)


def test_with_the_circular_spline_as_output_the_close_lines_lie_below() -> None:
    assert [round(o, 6) for o, _ in output_orders(50.0, "circular_spline")] == [0.02, 0.04, 1, 0.98, 2, 1.96, 4, 3.92]
    assert [round(o, 6) for o, _ in output_orders(50.0, "flexspline")] == [0.02, 0.04, 1, 1.02, 2, 2.04, 4, 4.08]
