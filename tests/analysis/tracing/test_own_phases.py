"""Runs that go both ways at one speed tell an order from a frequency, each run for itself."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import pytest

from rig.analysis.tracing.residual import slipping_order as module
from rig.analysis.tracing.residual.binned import Halves, folds
from rig.analysis.tracing.residual.joined import Rest
from rig.analysis.tracing.residual.own_phases import line_for_a_while, own_phases
from rig.analysis.tracing.residual.slipping_order import slipping_order
from rig.model.effect import Array

DT, ROWS, RUNS = 1 / 125, 6000, 4
PHASES = np.repeat([0.4, 2.9, 4.4, 1.6], ROWS)
RUN = np.repeat(np.arange(RUNS), ROWS)


def runs(both_ways: bool = True) -> dict[str, Array]:
    """Triangles of 48 s at one speed, or the same one way."""
    t = np.arange(ROWS) * DT
    way = np.where((t < 12) | (t > 36), 1.0, -1.0) if both_ways else np.ones(ROWS)
    angle = np.cumsum(way) * DT
    each = {"motor_angle": angle, "load_angle": angle / 50, "speed": way, "direction": way, "load": 5.0 * way}
    at = {name: np.tile(x, RUNS) for name, x in each.items()}
    return at | {"time": np.concatenate([60.0 * run + t for run in range(RUNS)])}


def left(at: dict[str, Array], made: Array, rng: np.random.Generator) -> Rest:
    return Rest(made + rng.normal(0, 1, RUNS * ROWS), RUN, at, DT, np.zeros((RUNS * ROWS, 0)), np.zeros((0, 0)))


@pytest.mark.parametrize("both_ways", [True, False])
def test_runs_of_one_speed_that_turn_back_tell_an_order_of_other_phases(
    both_ways: bool, rng: np.random.Generator
) -> None:
    at = runs(both_ways)
    r = left(at, 3.0 * np.cos(11.47 * at["motor_angle"] + PHASES), rng)
    found = own_phases(Halves(r, folds(r)), "A")
    assert (found.order if found else None) == (pytest.approx(11.47, abs=0.02) if both_ways else None)


@pytest.mark.parametrize("both_ways", [True, False])
def test_what_shakes_one_run_is_a_frequency_where_that_run_turns_back(
    both_ways: bool, rng: np.random.Generator
) -> None:
    at = runs(both_ways)
    r = left(at, np.where(RUN == 2, 3.0 * np.sin(2 * np.pi * 9.3 * at["time"]), 0.0), rng)
    found = line_for_a_while(Halves(r, folds(r)), "L")
    assert (found is not None) == both_ways
    if found is not None:
        assert found.frequency_hz == pytest.approx(9.3, abs=0.005)
        assert found.share > 0.9


def looked_for(monkeypatch: pytest.MonkeyPatch, r: Rest) -> Any:
    monkeypatch.setattr(module, "rest", lambda eq, e, floors, channel: r if channel == "A" else None)
    monkeypatch.setattr(module, "each", lambda work, items: [work(item) for item in items])
    return slipping_order(cast(Any, None), {}, {})


def test_an_order_of_other_phases_is_found_in_the_floor(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    at = runs()
    found = looked_for(monkeypatch, left(at, 3.0 * np.cos(11.47 * at["motor_angle"] + PHASES), rng))
    assert (found.channel, found.coordinate) == ("A", "motor_angle")
    assert found.order == pytest.approx(11.47, abs=0.02)
    assert found.share == pytest.approx(4.5 / 5.5, abs=0.05)  # half the square of its height, beside noise of 1


@pytest.mark.parametrize("shown", [1, 0])
def test_one_that_few_runs_show_makes_no_floor(
    shown: int, monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    at = runs()
    assert (
        looked_for(monkeypatch, left(at, np.where(shown > RUN, 3.0, 0.0) * np.cos(11.47 * at["motor_angle"]), rng))
        is None
    )
