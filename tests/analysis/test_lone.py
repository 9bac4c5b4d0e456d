"""Single readings far off their neighbours are none of the gear's: missing, and named; steps and noise stay."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rig.analysis import analyse
from rig.analysis.motion.lone import lone
from rig.core.units import TURN
from tests.analysis.synthetic import slow_run

T = np.arange(20_000) / 1000.0
COUNT = TURN / 65536


def turning(seed: int = 1) -> np.ndarray:
    """A motor angle at 400 rpm in counts, a little noise on it [rad]."""
    noise = np.random.default_rng(seed).standard_normal(T.size) * 1e-5
    return np.round((41.9 * T + 0.01 * np.sin(84.0 * T) + noise) / COUNT) * COUNT


@pytest.mark.parametrize("t", [T, None])
@pytest.mark.parametrize("rows", [slice(5000, 5001), slice(70, 73), slice(0, 1), slice(T.size - 1, T.size)])
def test_readings_that_stand_alone_are_found_with_what_they_are_off_by(t: np.ndarray | None, rows: slice) -> None:
    x = turning()
    x[rows] += 0.2
    found, off = lone(x, t)
    assert found.tolist() == list(range(rows.start, min(rows.stop, T.size)))
    assert off == pytest.approx(0.2, rel=0.05)


def test_motion_without_noise_hides_no_wrong_reading() -> None:
    x = 1.26 * T + 1e-3 * np.sin(3.0 * T)
    x[[7000, 12_000]] += 5.0, -8.0
    assert lone(x, T)[0].tolist() == [7000, 12_000]


def test_a_reversal_in_few_rows_a_second_stands_not_alone() -> None:
    t = np.arange(500) / 5.0
    for shift in np.linspace(0.0, 0.2, 9):
        x = np.abs((t + shift) % 50.0 - 25.0)
        assert lone(x + 0.01 * np.sin(2 * x), t)[0].size == 0


@pytest.mark.parametrize(
    "added",
    [
        np.zeros(T.size),
        np.where(T > 7.0, 0.2, 0.0),  # counts lost
        np.where(abs(T - 7.0) < 0.004, 0.2, 0.0),  # nine rows: it has a course
        np.where(np.arange(T.size) == 7000, -TURN, 0.0),  # to and fro over the zero of a wrapped angle
        0.2 * (np.random.default_rng(2).random(T.size) < 0.01),  # how this sensor reads
        np.maximum(T - 7.0, 0.0) * 40.0,  # a corner
    ],
)
def test_what_goes_on_or_comes_often_does_not_stand_alone(added: np.ndarray) -> None:
    assert lone(turning() + added, T, TURN)[0].size == 0


def test_a_torque_at_rest_may_have_one_wrong_reading() -> None:
    torque = np.full(T.size, 0.5)
    assert lone(torque, T)[0].size == 0
    torque[400:5000] += 0.01 * np.round(np.random.default_rng(3).standard_normal(4600))
    torque[9000] = 50.0
    assert lone(torque, T)[0].tolist() == [9000]


def test_rows_stamped_as_a_jittery_clock_ticked_do_not_stand_alone() -> None:
    t = T + 3e-4 * np.random.default_rng(4).random(T.size)
    assert lone(41.9 * t + np.sin(84.0 * t), t)[0].size == 0


def test_noise_of_a_million_rows_has_none() -> None:
    x = np.random.default_rng(5).standard_normal(1_000_000)
    assert lone(x, None)[0].size == 0


def test_an_analysis_leaves_it_out_and_says_so() -> None:
    run, count = slow_run(1), TURN / 1_296_000
    theta_l = np.round(run.columns["theta_l"] / count) * count
    clean, name = replace(run, columns={**run.columns, "theta_l": theta_l}), "kinematic_error_peak_to_peak"
    theta_l = theta_l.copy()
    theta_l[30_000] += 0.01
    one_wrong = analyse(replace(run, columns={**run.columns, "theta_l": theta_l}))
    before, after = (next(e.value for e in r.estimates if e.name == name) for r in (analyse(clean), one_wrong))
    assert after == pytest.approx(before, abs=0.1)  # arcsec
    assert any(
        "1 reading of theta_l stands alone, 2064 arcsec off its neighbours at t = " in s for s in one_wrong.cannot
    )
