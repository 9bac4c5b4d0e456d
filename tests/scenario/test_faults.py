"""Faults of the twin's devices in mid-run: tripped within a stated number of ticks, in words, torque off, rows kept."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest

from rig.bench import read
from rig.core.channels import Flag
from rig.core.errors import Exit
from rig.core.operator import HangWeight
from rig.guard import Guard
from rig.instruments import Instruments
from rig.loop import Ending, Loop
from rig.procedures.kinematic_error import KinematicError
from rig.process.interrupts import Interrupts
from rig.supervisor import Act, State, Supervisor
from rig.timing.ticks import LoopTiming
from sim.faults import Frozen, Jump, Overload, Silent
from tests.fakes import ListSink

PROCEDURE = KinematicError(amplitude_deg=360.0, frequency=0.04, cycles=1.0)  # reverses at 6.75 s and 19.25 s
PHASES = {"tracking forward": 3.0, "at the reversal": 6.751, "tracking in reverse": 12.0, "coming to rest": 25.4}

Strike = Callable[[Any], None]
FAULTS: dict[str, tuple[Strike, str, float]] = {
    # what happens, the word in the reason, detection time declared [s]
    "load encoder silent": (lambda rig: setattr(rig.load_encoder, "fault", Silent()), "load-encoder", 0.006),
    "motor encoder silent": (lambda rig: setattr(rig.drive, "fault", Silent()), "motor", 0.006),
    "torque sensor silent": (lambda rig: setattr(rig.torque_sensor, "fault", Silent()), "torque-sensor", 0.006),
    "load encoder jumps": (lambda rig: setattr(rig.load_encoder, "fault", Jump(0.02)), "disagree", 0.001),
    "motor encoder jumps": (lambda rig: setattr(rig.drive, "fault", Jump(1.0)), "", 0.001),
    "torque sensor overloaded": (lambda rig: setattr(rig.torque_sensor, "fault", Overload(1)), "shaft torque", 0.001),
    "drive trips": (lambda rig: rig.drive.trip("over-temperature"), "over-temperature", 0.001),
    # only its effect shows: 0.4° of twist at 9.6 rpm of the motor takes 0.35 s and what the loop lags
    "load encoder frozen": (lambda rig: setattr(rig.load_encoder, "fault", Frozen()), "disagree", 1.0),
    "motor encoder frozen": (lambda rig: setattr(rig.drive, "fault", Frozen()), "", 1.0),
}
UNSEEN = {("load encoder frozen", "coming to rest")}  # nothing moves any more


@pytest.mark.slow
def test_a_torque_sensor_that_repeats_itself_is_flagged_and_does_not_stop_the_run() -> None:
    ending, sink, _, _, struck, _ = run_with(lambda rig: setattr(rig.torque_sensor, "fault", Frozen()), 3.0)
    assert ending.status == "completed"
    flagged = [row[0].t for row in sink.rows if row[0].flags & Flag.FROZEN_TAU]
    assert flagged[0] == pytest.approx(struck + 1.0, abs=0.01)


def run_with(fault: Strike, at: float) -> tuple[Ending, ListSink, Instruments, Supervisor, float, float]:
    """With when it struck, and when the torque was commanded off [s]."""
    bench, supervisor, sink = read("twin"), Supervisor(), ListSink()
    rig, setting = bench.open("virtual"), bench.setting(lambda text: None)
    rig.connect()
    supervisor.act(Act.CONNECT)
    supervisor.act(Act.CHECK)
    world: Any = rig.clock
    struck = world.now() + at
    world.at(struck, lambda: fault(rig))
    guard = Guard(bench.limits, PROCEDURE.envelope(setting), setting.ratio)
    timing = LoopTiming(setting.period, virtual=True)
    off: list[float] = []
    loop = Loop(rig, supervisor, guard, sink, Interrupts(), timing, tripped=lambda why: off.append(world.now()))
    ending = loop.run(PROCEDURE, setting)
    return ending, sink, rig, supervisor, struck, *(off or [world.now()])


@pytest.mark.slow
@pytest.mark.parametrize("phase", PHASES)
@pytest.mark.parametrize("name", FAULTS)
def test_every_fault_in_every_phase_ends_without_torque_in_time(name: str, phase: str) -> None:
    strike, word, detection = FAULTS[name]
    ending, sink, rig, supervisor, struck, off = run_with(strike, PHASES[phase])
    world: Any = rig.clock
    assert sink.rows[-1][2] == 0.0
    if (name, phase) in UNSEEN:
        assert ending.status == "completed"
        return
    assert (ending.status, ending.exit) == ("tripped", Exit.TRIPPED)
    assert word in ending.reason
    assert supervisor.state is State.FAULT
    assert sink.rows[-1][0].flags & Flag.TRIPPED
    assert off - struck <= detection + 3 * 0.001 + 1e-9
    assert len(sink.rows) >= (struck - 0.0) * 1000 - 2  # every row before it is there
    world.wait_until(world.now() + 0.02)
    assert abs(world.truth().tau_m) < 1e-6
    rig.close()


@pytest.mark.slow
def test_a_load_that_drives_the_motor_on_after_a_trip_is_said() -> None:
    ending, *_ = run_with(lambda rig: rig.operator.make(HangWeight(30.0)), 3.0)
    assert ending.status == "tripped"
    assert re.search(r"; the motor turns on at \d+ rpm without torque: keep clear of it", ending.reason)


@pytest.mark.slow
def test_a_motor_that_comes_to_rest_after_a_trip_is_not_said_to_turn_on() -> None:
    ending, _, rig, _, _, off = run_with(lambda rig: rig.drive.trip("over-temperature"), 3.0)
    assert "turns on" not in ending.reason
    assert rig.clock.now() - off < 0.5
