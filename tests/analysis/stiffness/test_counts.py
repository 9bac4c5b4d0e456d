"""What a motor that sticks makes of the loop, standing at one end of a count on the way up and at the other down."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis import analyse
from rig.analysis.motion.source import motion_of
from rig.analysis.stiffness.counts import of_width, one_count
from rig.core.units import ARCMIN, TURN
from tests.analysis.stiffness.plant import K, LockedGear, N
from tests.analysis.stiffness.test_spring import figures
from tests.analysis.synthetic import MadeRun

COUNTS = 10_000
COUNT = TURN / COUNTS / N  # rad at the output
TORQUE_SPAN = 30.0  # N·m, from end to end


def sticking(apart: float) -> MadeRun:
    """An elastic gear whose motor stands in the middle of a count, `apart` of a count farther on the way down."""
    gear = LockedGear(rates=(1.0,), cycles=2)
    t, w = gear.time_and_windup()
    up = np.gradient(w) >= 0
    place = np.where(up, 0.5 - apart / 2, 0.5 + apart / 2)
    reading = np.floor(w / COUNT)
    tau = K * (reading + place) * COUNT + 0.03 * np.random.default_rng(1).standard_normal(t.size)
    columns = {"t": t, "theta_m": reading * COUNT * N, "theta_l": np.zeros_like(t), "tau_l": tau}
    about = {"procedure": "stiffness_lock", "gear": {"ratio": N}, "conditions": {"output_locked": True}}
    return MadeRun(columns, {**about, "encoders": {"motor_counts_per_rev": COUNTS}})


@pytest.mark.slow
def test_a_motor_that_stands_half_a_count_apart_looks_like_a_loop_and_the_interval_knows() -> None:
    found = figures(analyse(sticking(0.5)))
    loss, energy = found["hysteresis_loss"], found["hysteresis_energy"]
    assert loss.value == pytest.approx(-0.5 * COUNT / ARCMIN, rel=0.2), "arcmin, of a gear that has none"
    assert loss.ci95[0] < 0.0 < loss.ci95[1]
    assert energy.value == pytest.approx(-0.5 * COUNT * TORQUE_SPAN * 1e3, rel=0.2), "mJ"
    assert energy.ci95[0] < 0.0 < energy.ci95[1]
    assert "the motor stood on either branch" in loss.how


@pytest.mark.slow
def test_more_cycles_make_that_part_no_smaller() -> None:
    few, many = (figures(analyse(LockedGear(rates=(1.0,), cycles=n).run()))["hysteresis_loss"] for n in (1, 4))
    least = of_width(COUNT) / ARCMIN
    for figure in (few, many):
        assert (figure.ci95[1] - figure.ci95[0]) / 2 > least
    assert (many.ci95[1] - many.ci95[0]) / 2 < 1.3 * least


def test_nineteen_in_twenty_pairs_of_places_within_a_count_are_nearer_than_it_says() -> None:
    places = np.random.default_rng(3).uniform(size=(200_000, 2))
    assert np.mean(np.abs(places[:, 0] - places[:, 1]) < of_width(1.0)) == pytest.approx(0.95, abs=0.002)


def test_the_count_is_the_declared_one_or_the_least_step_seen() -> None:
    run = sticking(0.0)
    motion = motion_of(run)
    assert motion is not None
    bare = MadeRun(run.columns, {key: value for key, value in run.manifest.items() if key != "encoders"})
    assert one_count(run, motion) == pytest.approx(COUNT)
    assert one_count(bare, motion) == pytest.approx(COUNT)
