"""Friction that is more one way is told from a zero of the reading, from what hangs on the output, and from nothing."""

from __future__ import annotations

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.residual.uneven_friction import UnevenFriction, uneven_friction

FRICTION, NOISE, FLOOR = 0.18, 2e-3, 2e-3  # N·m at the motor
ROWS, RATIO = 4000, 50.0
BOTH = frozenset({"t", "theta_m", "theta_l", "tau_m", "tau_l"})


def run(seed: int, more: float, *, zero: float = 0.0, pulls: float = 0.0, **other: Any) -> Any:
    """A triangle: friction larger by `more` forward than backward, a `zero` of the reading, a load that `pulls`."""
    rng = np.random.default_rng(seed)
    way = np.repeat([1.0, -1.0], ROWS // 2)
    tau_m = (FRICTION + more / 2 * way) * way + zero + pulls / RATIO + NOISE * rng.standard_normal(ROWS)
    piece = SimpleNamespace(way=way, tau_m=tau_m, tau_l=0.4 * way + pulls, tau_ext=np.zeros(ROWS))
    made = {"procedure": "kinematic_error", "locked": False, "has": BOTH, "load_stated": True, "ratio": RATIO}
    return SimpleNamespace(**{**made, "pieces": (piece,), **other})


def standstill(zero: float = 0.0, noise: float = NOISE) -> Any:
    tau_m = zero + noise * np.random.default_rng(9).standard_normal(ROWS)
    pieces = (SimpleNamespace(tau_m=tau_m),)
    return SimpleNamespace(procedure="standstill", has=BOTH, locked=False, pieces=pieces, ratio=RATIO)


def found(
    more: float, still: Any = None, floor: float = FLOOR, torque_zero: float = 0.0, **of_the_runs: Any
) -> UnevenFriction | None:
    runs = [run(seed, more, **of_the_runs) for seed in (1, 2, 3)]
    return uneven_friction([*runs, still or standstill()], floor, torque_zero)


@pytest.mark.parametrize(("more", "way"), [(10e-3, "forward"), (-10e-3, "backward")])
def test_friction_that_is_more_one_way_is_told_with_its_size_and_an_interval(more: float, way: str) -> None:
    told = found(more)
    assert told is not None
    assert abs(told.size - more) < told.half < 0.5e-3
    assert f"mN·m more torque {way} than the other way" in told.sentence()


def test_a_pull_that_the_zero_of_the_torque_sensor_hides_is_no_friction() -> None:
    hidden = [run(seed, 0.0, pulls=0.2) for seed in (1, 2, 3)]
    for one in hidden:
        one.pieces[0].tau_l -= 0.15
    assert uneven_friction([*hidden, standstill()], FLOOR, 0.0) is not None
    assert uneven_friction([*hidden, standstill()], FLOOR, -0.15) is None


def one_way(way: float, more: float, speed: float = 30.0) -> Any:
    """A run at a constant speed, rad/s, with friction larger by `more` forward than backward."""
    tau_m = (FRICTION + more / 2 * way) * way + NOISE * np.random.default_rng(5).standard_normal(ROWS)
    ones = np.ones(ROWS)
    piece = SimpleNamespace(
        way=way * ones, omega_m=way * speed * ones, tau_m=tau_m, tau_l=0.4 * way * ones, tau_ext=0 * ones
    )
    return SimpleNamespace(
        procedure="constant_speed", locked=False, has=BOTH, load_stated=True, ratio=RATIO, pieces=(piece,)
    )


@pytest.mark.parametrize(
    ("faster", "speeds", "told"),
    [
        (10e-3, (30, 31), "than the other way, whatever the speed, while"),
        (10e-3, (30, 40), "than the other way while"),  # no pair as fast: nobody knows
        (1e-3, (30, 40), "than the other way while"),
        (1e-3, (30, 31), None),
    ],
)
def test_what_goes_away_as_the_motor_turns_faster_is_not_the_same_at_any_speed(
    faster: float, speeds: tuple[float, float], told: str | None
) -> None:
    slow = [run(seed, 10e-3) for seed in (1, 2, 3)]
    fast = [one_way(way, faster, speed) for way, speed in zip((1.0, -1.0), speeds, strict=True)]
    found = uneven_friction([*slow, *fast, standstill()], FLOOR, 0.0)
    assert (found is None) if told is None else (found is not None and told in found.sentence())


def test_alike_both_ways_or_within_the_floor_is_nothing() -> None:
    assert found(0.0) is None
    assert found(10e-3, floor=6e-3) is None


@pytest.mark.parametrize(
    ("still", "of_the_runs"),
    [
        (standstill(5e-3), {"zero": 5e-3}),  # the reading has that zero
        (standstill(0.0, noise=0.0), {"zero": 5e-3}),  # a drive that is off says nothing of its reading
        (standstill(), {"pulls": 0.5}),  # something pulls the load one way
        (standstill(), {"has": BOTH - {"tau_l"}}),  # or might
        (standstill(), {"load_stated": False}),
        (standstill(), {"locked": True}),
    ],
)
def test_what_may_be_no_friction_is_not_called_so(still: Any, of_the_runs: Mapping[str, Any]) -> None:
    more = 0.0 if {"zero", "pulls"} & of_the_runs.keys() else 10e-3
    assert found(more, still, **of_the_runs) is None


def test_without_a_standstill_or_with_one_run_alone_nothing_is_told() -> None:
    assert uneven_friction([run(seed, 10e-3) for seed in (1, 2)], FLOOR, 0.0) is None
    assert uneven_friction([run(1, 10e-3), standstill()], FLOOR, 0.0) is None
