"""Which runs are repeats: the same motion under the same torque, whatever a motor trembles on and how it sticks."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from rig.analysis.tracing.runs.alike import alike, repeats

TURNS: Any = {"input_locked": False, "wound": lambda piece: piece.theta_m}
DT, STEP = 0.004, 0.014  # s; rad, how far a motor that sticks goes at once


def lock_test(reach: float, seconds: float, seed: int) -> Any:
    """Two cycles of ±`reach` rad in steps, read in counts that tremble; each run slips at other instants."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, seconds, DT)
    smooth = reach * np.interp(8 * t / seconds % 4, [0, 1, 3, 4], [0.0, 1.0, -1.0, 0.0])
    slips = STEP * np.round((smooth + 0.003 * np.sin(t + rng.uniform(0, 6))) / STEP)
    theta = slips + 1e-4 * rng.integers(0, 2, t.size)
    piece = SimpleNamespace(theta_m=theta, omega_m=np.gradient(theta, DT), t=t, dt=DT)
    return SimpleNamespace(said="stiffness_lock", has=frozenset(), locked=True, pieces=(piece,), **TURNS)


def turning(speed: float, torque: float = 0.0) -> Any:
    """A run of 10 s at `speed` rad/s of the motor; the torque sensor says `torque` N·m."""
    t = np.arange(0.0, 10.0, DT)
    piece = SimpleNamespace(
        theta_m=speed * t, omega_m=np.full(t.size, speed), way=np.full(t.size, np.sign(speed)), t=t, dt=DT
    )
    return SimpleNamespace(
        said="kinematic_error", has=frozenset({"tau_l"}), locked=False, mean_torque=torque, pieces=(piece,), **TURNS
    )


def test_runs_of_one_speed_are_repeats_but_not_of_opposite_ways() -> None:
    assert alike(turning(3.0), turning(3.01))
    assert not alike(turning(3.0), turning(-3.0))


def test_runs_under_another_torque_are_none_whatever_their_words() -> None:
    assert alike(turning(3.0, 20.0), turning(3.0, 20.5))
    assert not alike(turning(3.0, 20.0), turning(3.0, 40.0))


def test_lock_tests_that_slip_at_other_instants_are_repeats() -> None:
    first = lock_test(0.07, 50.0, 1)
    assert all(alike(first, lock_test(0.07, 50.0, seed)) for seed in range(2, 12))


def test_lock_tests_whose_motor_sticks_a_little_sooner_are_repeats() -> None:
    assert alike(lock_test(0.14, 60.0, 1), lock_test(0.126, 54.0, 2))


def test_lock_tests_at_another_rate_or_to_another_torque_are_none() -> None:
    first = lock_test(0.07, 50.0, 1)
    assert not alike(first, lock_test(0.07, 100.0, 2))
    assert not alike(first, lock_test(0.07, 25.0, 2))
    assert not alike(first, lock_test(0.14, 50.0, 2))


def test_repeats_may_lie_as_far_apart_as_one_of_them_lasts() -> None:
    """One that begins when the other ends is no later than short ones that follow each other."""

    def lasting(speed: float, start: float, duration: float) -> Any:
        return SimpleNamespace(**{**vars(turning(speed)), "start": start, "duration": duration})

    short = [lasting(v, 40.0 * i, 30.0) for i, v in enumerate((5.0, 5.0, 9.0, 9.0, 14.0, 14.0))]
    slow = [lasting(1.0, 300.0, 180.0), lasting(1.0, 500.0, 180.0)]
    runs = [*short, *slow]
    assert (6, 7) in repeats(runs, range(8))
    runs[7].start = 900.0
    assert (6, 7) not in repeats(runs, range(8))
