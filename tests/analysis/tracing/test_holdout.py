"""Which runs are held out: whole conditions between others and repeats, none before or after all that are fitted."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.runs.holdout import _head_and_tail, _here_and_there, _stretches, split
from rig.analysis.tracing.runs.strokes import wound_back
from tests.analysis.tracing.test_few_channels import reduced


def run(speed: float, start: float) -> Any:
    """A run of 10 s at `speed` rad/s."""
    t = np.arange(2500) * 0.004
    piece = SimpleNamespace(
        theta_m=speed * t,
        omega_m=np.full(t.size, speed),
        way=np.ones(t.size),
        tau_ext=np.zeros(t.size),
        t=t,
        dt=0.004,
    )
    said = f"kinematic_error [('speed', {speed})]"
    return SimpleNamespace(
        locked=False,
        input_locked=False,
        wound=lambda piece: piece.theta_m,
        name=f"{speed}_{start}",
        procedure="kinematic_error",
        said=said,
        has=frozenset(),
        pieces=(piece,),
        start=start,
    )


class Piece:
    """As much of a piece as a cut needs."""

    def __init__(self, theta_m: np.ndarray) -> None:
        self.theta_m, self.omega_m = theta_m, np.gradient(theta_m, 0.004)

    def part(self, rows: slice) -> Piece:
        return Piece(self.theta_m[rows])

    @property
    def way(self) -> float:
        return float(np.sign(self.theta_m[-1] - self.theta_m[0]))


@pytest.mark.parametrize("turns", [6.0, 30.0])
def test_of_one_stroke_forth_and_back_both_ways_are_fitted_and_tested(turns: float) -> None:
    up = np.linspace(0.0, 2 * np.pi * turns, 12_000)
    whole: Any = SimpleNamespace(pieces=(Piece(np.concatenate([up, up[::-1]])),))
    fitted, tested = _stretches(whole) or ((), ())
    for part in (fitted, tested):
        assert {piece.way for piece in part} == {1.0, -1.0}  # type: ignore[attr-defined]
    assert sum(len(piece.theta_m) for piece in (*fitted, *tested)) > 0.98 * 24_000


def triangle(turns: float) -> np.ndarray:
    """Up, down to as much below, and back to where it began: the slow run of the paper, once."""
    quarter = np.linspace(0.0, 2 * np.pi * turns, 3000)
    return np.concatenate([quarter, quarter[::-1], -quarter, -quarter[::-1]])


def ways(theta: np.ndarray) -> set[float]:
    return set(np.sign(np.diff(theta)[np.diff(theta) != 0]))


def test_of_three_strokes_the_part_held_out_runs_both_ways() -> None:
    whole: Any = SimpleNamespace(locked=False, pieces=(Piece(triangle(4.0)),))
    fitted, tested = _head_and_tail(whole) or ((), ())
    for (piece,) in (fitted, tested):
        assert ways(piece.theta_m) == {1.0, -1.0}
    assert 0.3 < len(tested[0].theta_m) / 12_000 < 0.45


def test_strokes_of_less_than_a_turn_are_held_out_whole() -> None:
    whole: Any = SimpleNamespace(locked=False, pieces=(Piece(triangle(0.3)),))
    _, tested = _head_and_tail(whole) or ((), ())
    assert ways(tested[0].theta_m) == {1.0}


def held(runs: list[Any]) -> set[tuple[float, float]]:
    return {(runs[i].pieces[0].omega_m[0], runs[i].start) for i in split(runs, ()).held_out}


def test_the_first_and_the_last_run_are_fitted_whatever_else_is_held_out() -> None:
    speeds = (5.0, 10.0, 15.0, 20.0, 25.0, 30.0)
    in_order = [run(v, 100.0 * i + 50.0 * j) for i, v in enumerate(speeds) for j in (0, 1)]
    assert (15.0, 200.0) in held(in_order)
    assert (15.0, 250.0) in held(in_order)
    for first in speeds:
        for last in speeds:
            times = {v: 100.0 * i for i, v in enumerate([first, *(v for v in speeds if v not in (first, last)), last])}
            runs = [run(v, times[v] + 50.0 * j) for v in speeds for j in (0, 1)]
            found = held(runs)
            assert found
            assert (first, min(times.values())) not in found
            assert (last, max(times.values()) + 50.0) not in found


@pytest.mark.slow
def test_of_a_procedure_that_was_run_once_a_part_is_held_out(tmp_path: Path, shared: Path) -> None:
    names = ("slow_ke_1", "slow_ke_2", "speed_120rpm_1", "speed_120rpm_2", "lock_60_1")
    campaign = read_campaign(reduced(tmp_path, shared / "cases" / "open-1", names, ()))
    parts = split(campaign.runs, ())
    tested = sorted(parts.runs[i].name for i in parts.held_out)
    assert tested == ["lock_60_1 (part held out)", "slow_ke_2", "speed_120rpm_2"]
    assert sorted(parts.runs[i].name for i in parts.unseen) == ["slow_ke_2", "speed_120rpm_2"]
    lock = [parts.runs[i] for i in range(len(parts.runs)) if parts.runs[i].name.startswith("lock")]
    whole = next(run for run in campaign.runs if run.name == "lock_60_1")
    assert sum(run.duration for run in lock) == pytest.approx(whole.duration)
    assert parts.how.endswith("of what was done only once a third, whole turns or strokes")


def log(*speeds: float, locked: bool = False) -> Any:
    """A motor at work: four seconds forth at each of some speeds [rad/s], and back."""
    there = [np.linspace(0.0, speed * 4.0, 1000) for speed in speeds]
    pieces = (Piece(np.concatenate([x for way in there for x in (way, way[::-1])])),)
    return SimpleNamespace(pieces=pieces, locked=locked)


def test_a_log_of_many_speeds_is_tested_with_strokes_from_all_of_it() -> None:
    fast_at_last = (3.0, 5.0, 8.0, 4.0, 6.0, 9.0, 5.0, 3.0, 7.0, 20.0, 40.0, 30.0)
    fitted, tested = _here_and_there(log(*fast_at_last)) or ((), ())
    fastest = [max(float(np.abs(piece.omega_m).max()) for piece in part) for part in (fitted, tested)]
    assert min(fastest) > 25.0, "rad/s: neither is told of speeds that the other has alone"
    assert sum(piece.theta_m.size for piece in (*fitted, *tested)) == 24_000, "nothing is lost"
    assert 0.2 < sum(piece.theta_m.size for piece in tested) / 24_000 < 0.45
    for piece in (*fitted[1:], *tested):
        assert abs(float(piece.omega_m[1])) > 1.0, "rad/s: cut where the motor turns, not where it turns back"


def test_a_motion_that_is_repeated_or_short_is_tested_with_its_end() -> None:
    assert _here_and_there(log(*[5.0] * 12)) is None
    assert _here_and_there(log(3.0, 40.0, 5.0)) is None
    assert _here_and_there(log(*[3.0, 9.0] * 8, locked=True)) is None


def test_a_piece_of_a_log_that_is_too_short_to_cut_is_a_part_of_it() -> None:
    whole = log(*[3.0, 5.0, 8.0, 20.0] * 4)
    whole.pieces = (*whole.pieces, Piece(np.linspace(0.0, 40.0, 900)), Piece(np.linspace(0.0, 1.0, 60)))
    fitted, tested = _here_and_there(whole) or ((), ())
    assert sum(piece.theta_m.size for piece in (*fitted, *tested)) == 32_000 + 900 + 60


def test_a_hole_at_the_start_takes_nothing_from_what_is_fitted() -> None:
    """A sensor that reads nothing for half a second near the start of a lock test leaves two pieces of it."""
    theta = triangle(0.3)
    whole: Any = SimpleNamespace(locked=True, pieces=(Piece(theta[:900]), Piece(theta[1400:])))
    fitted, tested = _head_and_tail(whole) or ((), ())
    assert [len(piece.theta_m) for piece in fitted] == [900, 7600]
    assert sum(len(piece.theta_m) for piece in (*fitted, *tested)) == 11_500


def test_a_lock_test_that_goes_up_a_stair_is_cut_where_it_is_wound_up_most() -> None:
    """One cycle of a motor that sticks, and trembles on its steps: what is held out is within what is fitted."""
    t = np.arange(15_000) * 0.004
    smooth = np.interp(t / t[-1], [0.0, 0.25, 0.75, 1.0], [0.0, 0.08, -0.08, 0.0])
    theta = 0.014 * np.round(smooth / 0.014) + 2e-4 * np.sin(3.0 * t)
    whole: Any = SimpleNamespace(locked=True, pieces=(Piece(theta),))
    head, tail = (parts[0].theta_m for parts in _head_and_tail(whole) or ())
    assert head.min() < 0.98 * tail.min()
    assert tail.size == pytest.approx(theta.size / 4, rel=0.1)


def test_a_gear_wound_up_one_way_is_cut_at_a_stroke_as_ever() -> None:
    assert wound_back(np.linspace(0.0, 1.0, 100), 0.3) == []
    assert wound_back(np.abs(np.sin(np.linspace(0.0, 2 * np.pi, 401))), 0.3) == [100, 200, 300]
