"""What the zero of a torque sensor does to that of the angles is taken off before a line over the speed is asked."""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor import homed
from rig.analysis.tracing.floor.homed import about_a_line
from rig.analysis.tracing.looks import zeros as module
from rig.analysis.tracing.looks.zeros import with_torque_zeros
from rig.analysis.tracing.runs.holdout import HELD_PART
from rig.model.effect import MEASURED

RATIO, SOFT, LATE = 160.0, 1 / 28000.0, 3.2e-5  # rad/(N·m), s
SPEEDS = np.array([50.0, 50.0, 30.0, 30.0, -30.0, -30.0, -6.0, 15.0])  # rad/s of the motor
CREEP = 0.1 * np.array([-0.5, -0.7, -0.1, -0.5, -1.6, -1.3, -0.6, 1.2])  # N·m


def solution(monkeypatch: pytest.MonkeyPatch, creep: np.ndarray) -> Any:
    """Of eight runs whose load angle is read late, and whose torque sensor has another zero in each."""
    zeros = {"A": LATE * SPEEDS / RATIO - SOFT * creep, "L": creep}
    for name in ("offset", "zero"):
        monkeypatch.setattr(homed, name, lambda s, run, channel: zeros[channel][run])
    pieces = [[SimpleNamespace(omega_m=np.full(9, w))] for w in SPEEDS]
    runs = [
        SimpleNamespace(locked=False, has=MEASURED, ratio=RATIO, pieces=p, name=f"run {i}")
        for i, p in enumerate(pieces)
    ]
    keys = [(i, c) for i in range(SPEEDS.size) for c in "AL"]
    eq = SimpleNamespace(runs=runs, rows=dict.fromkeys(keys))
    return SimpleNamespace(
        design=SimpleNamespace(eq=eq, terms=()), keys=keys, value=lambda name: {"compliance": SOFT}[name]
    )


def test_beside_a_torque_sensor_that_creeps_a_late_angle_still_lies_on_a_line(monkeypatch: pytest.MonkeyPatch) -> None:
    scatter = about_a_line(solution(monkeypatch, CREEP))
    assert scatter == pytest.approx(0.0, abs=1e-12)
    monkeypatch.setattr(homed, "torque_zero", lambda s, run: 0.0)
    assert about_a_line(solution(monkeypatch, CREEP)) is None


@dataclass(frozen=True)
class Piece:
    torque: np.ndarray
    tau_l: np.ndarray


@dataclass(frozen=True)
class Run:
    name: str
    pieces: tuple[Piece, ...]


@dataclass(frozen=True)
class Campaign:
    runs: tuple[Run, ...]


def test_each_run_loses_its_own_zero_and_one_that_was_split_the_mean_of_its_parts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    piece = Piece(np.array([4.0, 6.0]), np.array([4.5, 5.5]))
    campaign: Any = Campaign(tuple(Run(name, (piece,)) for name in ("slow", "fast", "lock")))
    names = {"slow": 0.2, f"slow ({HELD_PART})": 0.4, "fast": -0.1, "lock": 9.0}
    runs = [SimpleNamespace(name=name, locked=name == "lock") for name in names]
    s: Any = SimpleNamespace(design=SimpleNamespace(eq=SimpleNamespace(runs=runs)))
    monkeypatch.setattr(module, "torque_zero", lambda s, run: [*names.values()][run])
    slow, fast, lock = with_torque_zeros(campaign, s).runs
    np.testing.assert_allclose(slow.pieces[0].torque, [3.7, 5.7])
    np.testing.assert_allclose(fast.pieces[0].tau_l, [4.6, 5.6])
    assert lock == replace(campaign.runs[2])


def test_a_line_that_is_little_beside_what_was_taken_off_is_the_balance_of_the_load(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A sensor that was tared anew before the fast runs: the drag of the load has taken on a tenth of that."""
    tared = 0.35 * (np.abs(SPEEDS) > 20)
    s = solution(monkeypatch, tared)
    drag = 0.1 * 0.35 * SPEEDS / 50.0
    monkeypatch.setattr(homed, "torque_zero", lambda s, run: float(tared[run] + drag[run]))
    monkeypatch.setattr(homed, "zero", lambda s, run, channel: float(-SOFT * tared[run]))
    assert about_a_line(s) is None
