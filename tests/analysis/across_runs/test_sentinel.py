"""Sentinels side by side: a change beyond what both can tell is one, a smaller one is not."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.across_runs.sentinel import WATCHED, compare
from rig.analysis.findings.result import Estimate


def sentinel(torque: float, half: float = 0.002) -> list[Estimate]:
    return [
        Estimate("mean_motor_torque", "Mean motor torque", torque, "N·m", (torque - half, torque + half), "made up")
    ]


def test_a_change_beyond_both_intervals_is_told_with_its_numbers() -> None:
    (torque,) = compare([sentinel(0.40), sentinel(0.42), sentinel(0.44)])
    assert torque.changed
    assert torque.change == pytest.approx(0.04)
    assert torque.change_half == pytest.approx(0.002 * 2**0.5 * 2.858 / 1.96, rel=1e-3)  # 12 comparisons, 1 in 20
    assert torque.sentence.startswith("Mean motor torque changed: 0.4 N·m first, 0.44 N·m last, change +0.04 ± 0.0041")


def test_a_change_within_the_intervals_is_none() -> None:
    (torque,) = compare([sentinel(0.400), sentinel(0.402)])
    assert not torque.changed
    assert "did not change" in torque.sentence


@pytest.mark.parametrize("change", np.linspace(0.001, 0.006, 26))
def test_the_interval_that_is_printed_is_the_one_that_decides(change: float) -> None:
    (torque,) = compare([sentinel(0.4), sentinel(0.4 + change)])
    assert torque.changed == (abs(torque.change) > torque.change_half)


def test_an_excursion_in_the_middle_is_a_change_although_it_came_back() -> None:
    (torque,) = compare([sentinel(0.40), sentinel(0.45), sentinel(0.40)])
    assert torque.changed
    assert "sentinels 1 and 2 differ by +0.05 N·m" in torque.sentence


def test_with_many_sentinels_of_an_unchanged_rig_it_is_rarely_said_to_have_changed() -> None:
    scatter = np.random.default_rng(4).standard_normal((200, 4))
    told = [compare([sentinel(0.4 + 0.001 * x, 0.00196) for x in campaign])[0].changed for campaign in scatter]
    assert sum(told) <= 10  # 5 %; with the bare intervals one in five
    assert compare([sentinel(0.4), sentinel(0.4), sentinel(0.4), sentinel(0.406)])[0].changed


def test_one_sentinel_and_figures_that_one_of_them_lacks_are_not_compared() -> None:
    assert compare([sentinel(0.4)]) == ()
    assert compare([sentinel(0.4), []]) == ()
    assert set(WATCHED) >= {"mean_speed", "mean_motor_torque", "kinematic_error_peak_to_peak", "fourier_amplitude_2"}
