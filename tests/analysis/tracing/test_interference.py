"""A line beside the motion is found, steady or wandering; an order of the shaft is none, and noise is none."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scipy.signal import lfilter

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor import interference
from rig.analysis.tracing.floor.interference import Interference, find_interference
from rig.model.effect import Array

DT, N = 0.004, 10_000
T = DT * np.arange(N)
SPEEDS = (1.0, 6.3, 21.0, 42.0)


class Run:
    """Just what the search looks at."""

    locked = False
    has = frozenset({"t", "tau_l"})
    gear = SimpleNamespace(K=7160.0, J_l=0.8)  # 15.1 Hz

    def __init__(self, turning: float, even: bool = True) -> None:
        self.turning, self.even = turning, even

    def keeps_speed(self, within: float) -> bool:
        return self.even


class Rig:
    """Runs at the four speeds."""

    runs = tuple(Run(w) for w in SPEEDS)


@pytest.fixture(autouse=True)
def _clock(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(interference, "clock", lambda eq, key: T)


def residuals(line: Any) -> dict[Key, Array]:
    rng = np.random.default_rng(4)
    return {(i, "L"): 0.05 * rng.standard_normal(N) + line(w) for i, w in enumerate(SPEEDS)}


def look(e: dict[Key, Array], rig: Any = Rig) -> interference.Interference | None:
    return find_interference(cast(Equations, rig()), e, {})


def test_a_steady_line_is_found_at_its_frequency_and_taken_away() -> None:
    e = residuals(lambda w: 0.1 * np.sin(2 * np.pi * 3.7 * T + w))
    found = look(e)
    assert found is not None
    assert found.frequency_hz == pytest.approx(3.7, abs=0.05)
    left = np.concatenate([e[k] - found.columns[k][:, 0] for k in e])
    assert np.std(left) == pytest.approx(0.05, rel=0.05)


def test_what_wanders_about_the_gear_s_own_resonance_is_no_line_and_what_stands_there_is_one() -> None:
    wander = 2 * np.pi * (14.0 * T + 14.0 * 0.1 / (2 * np.pi * 0.01) * np.sin(2 * np.pi * 0.01 * T))
    assert look(residuals(lambda w: 0.1 * np.sin((1 + w / 420) * wander))) is None
    assert look(residuals(lambda w: 0.1 * np.sin(2 * np.pi * 14.0 * T + w))) is not None


@pytest.mark.parametrize(("even", "found"), [(True, True), (False, False)])
def test_what_wanders_far_while_the_motor_turns_evenly_is_no_order_and_no_resonance(even: bool, found: bool) -> None:
    """At one speed throughout, and about the gear's own resonance; where the speed wanders an order does so too."""
    alike = type("Alike", (), {"runs": tuple(Run(1.0, even) for _ in SPEEDS)})
    wander = 2 * np.pi * (14.0 * T + 14.0 * 0.2 / (2 * np.pi * 0.01) * np.sin(2 * np.pi * 0.01 * T))
    assert (look(residuals(lambda w: 0.1 * np.sin(wander + w)), alike) is not None) == found


def test_orders_that_come_near_a_resonance_are_no_line_that_wanders() -> None:
    """Of an inertia on a spring at 26 Hz each run shows the order that is nearest: 26.7, 26.1 and 25.9 Hz."""

    def nearest(speed: float) -> Array:
        turns = speed / (2 * np.pi)
        return np.asarray(0.1 * np.sin(np.round(26.0 / turns) * speed * T))

    assert look(residuals(nearest)) is None
    assert look(residuals(lambda w: 0.1 * np.sin(2 * np.pi * (25.0 + 0.31 * w**0.5) * T))) is not None


def test_a_wandering_line_is_found_and_taken_away() -> None:
    wander = 2 * np.pi * (8.0 * T + 8.0 * 0.2 / (2 * np.pi * 0.01) * np.sin(2 * np.pi * 0.01 * T))
    e = residuals(lambda w: 0.1 * np.sin(wander + w))
    found = look(e)
    assert found is not None
    assert 6.4 < found.frequency_hz < 9.6
    assert np.std(np.concatenate([e[k] - found.columns[k][:, 0] for k in e])) < 0.056


def test_what_follows_the_speed_is_an_order_and_no_line() -> None:
    assert look(residuals(lambda w: 0.1 * np.sin(2 * w * T))) is None


def test_noise_has_no_line() -> None:
    assert look(residuals(lambda w: 0.0)) is None


@pytest.mark.slow
def test_friction_that_wanders_has_most_of_its_power_at_the_lowest_frequencies_and_no_line() -> None:
    rng = np.random.default_rng(11)
    for _ in range(4):
        red = {(i, "L"): lfilter([0.1], [1, -np.exp(-DT / 0.3)], rng.standard_normal(N)) for i in range(len(SPEEDS))}
        assert look(red) is None


@pytest.mark.parametrize("k", [1, 2, 3, 8, 9, 200, 201])
def test_what_is_usual_around_a_frequency_is_the_median(k: int) -> None:
    power = np.random.default_rng(k).standard_exponential((7, k))
    np.testing.assert_array_equal(interference._median(power), np.median(power, axis=1))


def test_a_faint_line_makes_no_floor_too_high_and_is_left() -> None:
    assert look(residuals(lambda w: 0.02 * np.sin(2 * np.pi * 3.7 * T))) is None


@pytest.mark.parametrize("read", [True, False])
def test_without_a_torque_sensor_a_line_may_as_well_be_a_torque_on_the_load(read: bool) -> None:
    said = Interference("A", 6.39, 1.0, 0.6, {}, torque_read=read).sentence()
    assert ("no torque on the load makes it" in said) == read
    assert ("nobody can tell whether a torque on the load makes it" in said) != read
