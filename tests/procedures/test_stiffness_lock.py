"""The lock test on the twin: what it winds up, what it refuses, and how it lets go."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import pytest

from rig.bench import read
from rig.cli import main
from rig.control.winding import stiffer
from rig.core.errors import Exit, NotReady, UsageError
from rig.core.operator import LockOutput
from rig.core.sample import Sample, Torque
from rig.guard import Guard
from rig.loop import Ending, Loop
from rig.procedures.stiffness_lock import StiffnessLock, Unwound
from rig.procedures.unwind import Unwind
from rig.process.interrupts import Interrupts
from rig.supervisor import Act, Supervisor
from rig.timing.ticks import LoopTiming
from tests.fakes import GAINS, ListSink

SHORT: dict[str, Any] = {"tau_max": 10.0, "rate": 5.0, "cycles": 1, "hold": 0.3, "rates": (1.0,)}


class Ran(NamedTuple):
    ending: Ending | NotReady
    t: npt.NDArray[np.float64]
    motor: npt.NDArray[np.float64]  # rad from the start
    shaft: npt.NDArray[np.float64]  # N·m
    asked: npt.NDArray[np.float64]
    notes: list[str]
    left: float  # N·m, what the gear still gives to the locked output


def run(
    procedure: StiffnessLock, *, lock: bool = True, stop_at: int = 0, presses: int = 1, overrides: Sequence[str] = ()
) -> Ran:
    bench, supervisor, interrupts, sink = read("twin", overrides), Supervisor(), Interrupts(), ListSink()
    notes: list[str] = []
    rig, setting = bench.open("virtual"), bench.setting(notes.append)
    rig.connect()
    supervisor.act(Act.CONNECT)
    supervisor.act(Act.CHECK)
    assert rig.operator is not None
    if lock:
        rig.operator.make(LockOutput())

    def watch(sample: object) -> None:
        if stop_at and len(sink.rows) >= stop_at:
            interrupts.count = presses

    guard = Guard(bench.limits, procedure.envelope(setting), setting.ratio)
    loop = Loop(rig, supervisor, guard, sink, interrupts, LoopTiming(setting.period, virtual=True), watch)
    ending: Ending | NotReady
    try:
        ending = loop.run(procedure, setting)
    except NotReady as refusal:
        ending = refusal
    left = rig.operator.world.truth().tau_l  # type: ignore[attr-defined]
    rows = [(s.t, s.theta_m, s.tau_l, asked) for s, asked, *_ in sink.rows]
    t, motor, shaft, asked = np.array(rows).T
    rig.close()
    return Ran(ending, t, motor - motor[0], shaft, asked, notes, left)


@pytest.mark.slow
def test_it_winds_both_ways_to_the_torque_asked_for_and_ends_unwound() -> None:
    done = run(StiffnessLock(**SHORT))
    assert isinstance(done.ending, Ending)
    assert done.ending.status == "completed"
    assert 10.0 < done.shaft.max() < 13.0
    assert -13.0 < done.shaft.min() < -10.0
    assert abs(done.left) < 2.5, "one slip of the motor at most"
    assert 6500 < done.ending.finding.stiffness < 7800
    assert "unwound to" in done.ending.finding.sentence


def test_a_free_output_is_refused_with_numbers_before_anything_is_wound_up() -> None:
    done = run(StiffnessLock(**SHORT), lock=False)
    assert isinstance(done.ending, NotReady)
    assert "the load turned by +0.0" in str(done.ending)
    assert "the output is not locked" in str(done.ending)
    assert np.abs(done.shaft).max() < 4.0
    assert np.abs(done.motor).max() < np.radians(4.0)


@pytest.mark.slow
def test_a_gear_far_softer_than_declared_is_refused_unwound() -> None:
    done = run(StiffnessLock(**SHORT), overrides=("twin.effects.stiffness.gap_deg=0.3",))
    assert isinstance(done.ending, NotReady)
    assert "is the declared stiffness right" in str(done.ending)
    assert abs(done.left) < 2.5


@pytest.mark.parametrize("stop_at", [1500, 4000, 6500])
def test_a_stop_unwinds_the_gear_along_a_ramp_neither_held_nor_let_go(stop_at: int) -> None:
    done = run(StiffnessLock(**SHORT), stop_at=stop_at)
    assert isinstance(done.ending, Ending)
    assert done.ending.exit is Exit.STOPPED
    assert abs(done.left) < 2.5
    assert any("unwound from" in note for note in done.notes)
    before = abs(float(done.shaft[stop_at : stop_at + 100].mean()))
    took = float(done.t[-1] - done.t[stop_at])
    assert took > 0.5 * before / 5.0, "5 N·m/s, not at once"
    assert took < 3.0 * before / 5.0 + 2.0


def test_a_second_stop_lets_go_at_once() -> None:
    done = run(StiffnessLock(**SHORT), stop_at=4000, presses=2)
    assert isinstance(done.ending, Ending)
    assert done.ending.exit is Exit.HALTED
    assert "the shaft still carries" in done.ending.reason  # the pin holds it, and friction the motor
    assert len(done.t) < 4300


def test_the_shaft_torque_is_held_to_what_was_announced() -> None:
    bench = read("twin")
    procedure, setting = StiffnessLock(**SHORT), bench.setting(lambda text: None)
    guard = Guard(bench.limits, procedure.envelope(setting), setting.ratio)
    assert guard.shaft_torque == pytest.approx(16.0)
    assert Guard(bench.limits, StiffnessLock(tau_max=40.0).envelope(setting), setting.ratio).shaft_torque == 45.0


def test_the_energy_and_how_it_is_let_out_are_said_beforehand() -> None:
    energy, unwinding = StiffnessLock().remarks(read("twin").setting(lambda text: None))
    assert "0.016 J" in energy
    assert "±6.0° of the motor" in energy
    assert "unwinds it at 5 N·m/s, 3.0 s at most" in unwinding


def test_cycles_are_made_at_the_first_rate_and_one_at_each_other() -> None:
    ramps = StiffnessLock(tau_max=8.0, rate=2.0, cycles=2, rates=(1.0, 0.5)).ramps
    assert ramps == [(8, 2), (-8, 2), (8, 2), (-8, 2), (8, 1), (-8, 1), (0, 2)]


@pytest.mark.parametrize("wrong", [{"cycles": 0}, {"rates": ()}, {"rates": (1.0, -1.0)}])
def test_parameters_that_cannot_be_meant_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(UsageError):
        StiffnessLock(**wrong)


def test_a_stiffer_loop_keeps_its_damping() -> None:
    four = stiffer(GAINS, 4.0)
    assert (four.Kp, four.Ki) == (4 * GAINS.Kp, 4 * GAINS.Ki)
    assert four.Kd**2 / four.Kp == pytest.approx(GAINS.Kd**2 / GAINS.Kp)


@pytest.mark.slow
def test_unwinding_by_name_turns_nothing_for_less_than_a_slip_of_the_motor(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", "unwind", "--out", str(tmp_path)]) == 0
    said = r"^the shaft shows [+-]0\.\d\d N·m, not more than 1 N·m: nothing was turned$"
    assert re.search(said, capsys.readouterr().out, re.MULTILINE)


def unwound(shaft: Callable[[float], float]) -> Unwound:
    """What unwinding makes of a gear that gives `shaft` N·m for so many rad that the motor has turned."""
    bench = read("twin")
    setting = bench.setting(lambda text: None)
    steps, theta, now = Unwind().steps(setting), 0.0, 0.0
    next(steps)
    while True:
        sample = Sample(now, theta, 0.0, 0.0, 0.0, shaft(theta), 0.0, 0, 0, 0, "")
        try:
            asked = steps.send(sample)
        except StopIteration as end:
            return end.value  # type: ignore[no-any-return]
        theta = asked.theta_ref if isinstance(asked, Torque) and np.isfinite(asked.theta_ref) else theta
        now += setting.period


def test_a_gear_that_is_wound_up_is_let_out_till_a_slip_would_not_better_it() -> None:
    done = unwound(lambda theta: 12.0 + 7200.0 / 50.0 * theta)
    assert done.before == pytest.approx(12.0)
    assert 0.0 < done.after <= 1.05


def test_a_shaft_that_goes_on_showing_torque_is_no_gear_whose_pin_may_be_pulled() -> None:
    with pytest.raises(NotReady, match=r"unwound from \+8\.00 to \+8\.00 N·m; .* 2\.5 N·m at most: the pin stays in"):
        unwound(lambda theta: 8.0)


def test_a_gain_that_the_loop_cannot_follow_is_refused_with_the_most_it_may_be(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It wound the gear up beyond the limit of the run, as the loop shook."""
    for more in ([], ["--dry-run"]):
        assert main(["run", "stiffness-lock", "--with", "gain=1e6", "--out", str(tmp_path / "out"), *more]) == 3
        assert (
            "asks for up to 52223.3 rad/s of the position loop (gain = 1e+06 times K_p, at most 90.7 times here), the "
            "bench allows 500 rad/s"
        ) in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
    assert main(["run", "stiffness-lock", "--with", "gain=90.7", "--dry-run"]) == 0
    assert re.search(r"^loop +499\.\d+ of 500 rad/s, margin 0 %$", capsys.readouterr().out, re.M)


@pytest.mark.slow
def test_the_most_gain_that_is_allowed_winds_up_within_the_limit_of_the_run() -> None:
    ran = run(StiffnessLock(**SHORT, gain=90.0))
    assert not isinstance(ran.ending, NotReady)
    assert ran.ending.exit is Exit.PASS


def test_a_dry_run_says_at_what_the_guard_ends_the_run(capsys: pytest.CaptureFixture[str]) -> None:
    """Which is not the limit of the bench: the shaft may carry 45 N·m, in this run it trips at half of it."""
    assert main(["run", "stiffness-lock", "--dry-run"]) == 0
    told = "guard       ends this run beyond 28.4 deg of the motor from its start, 600 rpm, 22.5 N·m at the shaft"
    assert told in capsys.readouterr().out.splitlines()
    bench = read("twin", [])
    setting = bench.setting(lambda text: None)
    assert Guard(bench.limits, StiffnessLock().envelope(setting), setting.ratio).shaft_torque == 22.5
