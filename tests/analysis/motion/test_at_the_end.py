"""A sensor at the end of its range."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rig.analysis import analyse
from rig.analysis.motion.at_the_end import AtTheEnd, at_ends, ends
from tests.analysis.synthetic import slow_run

N = 20_000
ANGLE = np.linspace(0.0, 50.0, N)  # rad of the motor


def wave(noise: float, count: float) -> np.ndarray:
    """A slow wave of 10 N·m as a sensor of so much noise and so coarse a count reads it."""
    x = 10.0 * np.sin(ANGLE) + noise * np.random.default_rng(3).standard_normal(N)
    return np.round(x / count) * count


def test_a_wave_cut_off_at_both_sides_ends_there() -> None:
    found = ends(np.clip(wave(0.05, 0.01), -8.0, 9.0), ANGLE)
    assert [end.value for end in found] == [-8.0, 9.0]
    assert all(end.count > 0.1 * N for end in found)


def test_the_rows_at_the_ends_are_those_that_were_cut_off() -> None:
    x = wave(0.05, 0.01)
    cut = np.minimum(x, 9.0)
    assert np.array_equal(at_ends(cut, ends(cut, ANGLE)), np.flatnonzero(x >= 9.0))


@pytest.mark.parametrize(("noise", "count"), [(0.0, 0.01), (0.0, 0.1), (0.05, 0.01), (0.3, 0.5)])
def test_a_wave_within_its_range_has_no_ends(noise: float, count: float) -> None:
    assert ends(wave(noise, count), ANGLE) == []


def test_a_torque_that_is_held_while_its_motor_rests_has_no_ends() -> None:
    held = np.clip(1.2 * wave(0.0, 0.01), -10.0, 10.0)
    assert ends(held, held / 50.0) == []


def test_a_coarse_sensor_that_knows_few_values_has_no_ends() -> None:
    assert ends(np.clip(wave(0.0, 1.0), -4.0, 4.0), ANGLE) == []


def test_missing_readings_are_no_end() -> None:
    x = np.clip(wave(0.05, 0.01), -8.0, 20.0)
    x[:3000] = np.nan
    (found,) = ends(x, ANGLE)
    assert found == AtTheEnd(-8.0, int(np.count_nonzero(x == -8.0)))


def test_without_a_motor_angle_nothing_tells_an_end_from_a_rest() -> None:
    assert ends(np.clip(wave(0.05, 0.01), -8.0, 8.0), None) == []


def test_an_analysis_says_where_a_torque_ends_and_goes_on_without_it() -> None:
    run = slow_run(1)
    rng = np.random.default_rng(5)
    torque = np.round(3.0 * np.sin(run.columns["theta_l"] * 7.0) + 0.1 * rng.standard_normal(run.columns["t"].size), 3)
    whole, cut = (
        analyse(replace(run, columns={**run.columns, "tau_l": tau})) for tau in (torque, np.clip(torque, -2.0, 9.0))
    )
    assert not any("end of a range" in note for note in whole.cannot)
    (said,) = [note for note in cut.cannot if "end of a range" in note]
    assert said.startswith("tau_l ends at −2 N·m, in ")
    assert said.endswith("so it was not used.")
