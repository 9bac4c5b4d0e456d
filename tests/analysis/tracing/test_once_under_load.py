"""The only jump of a campaign has a name only where nothing could have given way there."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor import once_under_load as asked
from rig.analysis.tracing.floor.once_under_load import once_under_load
from rig.analysis.tracing.floor.steps import Steps
from rig.model.effects.missed_counts import LOAD

JUMP = 1.3e-4  # rad


@pytest.fixture
def eq(monkeypatch: pytest.MonkeyPatch) -> Any:
    """A run without a weight, one that drives 40 N·m, and one whose torque nobody measured; 10 ms between rows."""
    monkeypatch.setattr(asked, "clock", lambda eq, key: 900.0 + 0.01 * np.arange(1000))
    monkeypatch.setattr(asked, "made_by", lambda eq, run, row, side: {})  # nobody read a torque
    torques = {"slow_ke_1": 0.4, "load_40nm_1": 40.0, "unread": 0.0}
    return SimpleNamespace(runs=[SimpleNamespace(name=name, mean_torque=torque) for name, torque in torques.items()])


def jumps(*found: tuple[int, float]) -> Steps:
    """One in each of these runs, at row 500, by so much."""
    rows: dict[int, tuple[int, ...]] = {run: (500,) for run, _ in found}
    sizes: dict[int, tuple[float, ...]] = {run: (size,) for run, size in found}
    return Steps(rows, sizes, dict.fromkeys(rows, (LOAD,)), dict.fromkeys(rows, (1e-7,)))


def test_under_load_and_the_way_it_pulls_it_may_be_the_gear(eq: Any) -> None:
    found = once_under_load(eq, {}, jumps((1, JUMP)))
    assert found is not None
    assert (found.run, found.at, found.size, found.torque) == ("load_40nm_1", 905.0, JUMP, 40.0)
    assert "26.8 arcsec at 905 s in load_40nm_1, under 40 N·m" in found.sentence()


@pytest.mark.parametrize(
    "steps",
    [
        jumps((1, -JUMP)),  # nothing gives way against the torque
        jumps((0, JUMP)),  # nor without one
        jumps((2, JUMP)),  # of what nobody measured nothing is said
        jumps((0, -JUMP), (1, JUMP)),  # and counts are lost again, elsewhere
        jumps(),
    ],
)
def test_else_it_is_lost_counts(eq: Any, steps: Steps) -> None:
    assert once_under_load(eq, {}, steps) is None


@pytest.mark.parametrize(
    ("share", "noise", "gear"),
    [(0.0, 1.0, True), (1.0, 1.0, False), (-1.0, 1.0, True), (0.9, 10.0, True)],
    ids=["nothing seems to speed up", "as if it did", "the other way", "nothing is known"],
)
def test_a_load_that_seems_to_speed_up_and_is_felt_by_nobody_is_the_readings(
    eq: Any, monkeypatch: pytest.MonkeyPatch, share: float, noise: float, gear: bool
) -> None:
    """A jump of the reading is an acceleration forth and back; what let the load go has a torque to go with it."""
    spike = np.zeros((1000, 1))
    spike[498:503, 0] = -1e3, -2e3, 0.0, 2e3, 1e3  # N·m for each rad
    monkeypatch.setattr(asked, "made_by", lambda eq, run, row, side: {"A": np.ones((1000, 1)), "L": spike})
    eq.noise = SimpleNamespace(weight=lambda c: 1 / (0.05 * noise) ** 2)
    eq.without_offset = lambda key, x: x
    left = {(1, "A"): np.full(1000, JUMP), (1, "L"): share * JUMP * spike[:, 0]}
    assert (once_under_load(eq, left, jumps((1, JUMP))) is not None) == gear
