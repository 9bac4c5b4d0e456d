"""Every way out of the loop leaves the drive without torque, first; ticks missed are counted and never replayed."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import pytest

from rig.core.channels import Flag
from rig.core.devices import TorqueReading
from rig.core.errors import Exit, HdrigError, NotReady, RecorderError
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Mode, Sample, Torque
from rig.guard import Guard, Trip
from rig.instruments import Instruments
from rig.loop import Ending, Loop
from rig.procedures.jog import Jog
from rig.procedures.sign_and_scale import SignAndScale
from rig.process.interrupts import Interrupts
from rig.supervisor import PRESS, UNCONFIRMED, Act, State, Supervisor
from rig.timing.ticks import LoopTiming
from tests.fakes import LIMITS, SETTING, FakeWorld, ListSink, instruments


@dataclass(frozen=True)
class Constant(Procedure):
    """Half a newton metre for two seconds; calls `at` on the world at tick 500."""

    name: ClassVar[str] = "other"
    needs: ClassVar[tuple[str, ...]] = ("theta_m",)
    at: Callable[[], None] = lambda: None
    tau: float = 0.31

    def envelope(self, setting: Setting) -> Envelope:
        return Envelope(2.0, 300.0, 60.0, 5.0)

    def steps(self, setting: Setting) -> Steps:
        for k in range(2000):
            if k == 500:
                self.at()
            yield Torque(self.tau)
        return "found"


class Bench:
    def __init__(self) -> None:
        self.world, self.sink, self.interrupts = FakeWorld(), ListSink(), Interrupts()
        self.supervisor, self.timing = Supervisor(), LoopTiming(0.001, virtual=True)
        self.supervisor.act(Act.CONNECT)
        self.supervisor.act(Act.CHECK)
        self.instruments = instruments(self.world)

    def run(
        self,
        at: Callable[[], None] = lambda: None,
        tau: float = 0.31,
        tripped: Callable[[str], None] = lambda why: None,
    ) -> Ending:
        procedure = Constant(at, tau)
        guard = Guard(LIMITS, procedure.envelope(SETTING), 50.0)
        loop = Loop(self.instruments, self.supervisor, guard, self.sink, self.interrupts, self.timing, tripped=tripped)
        return loop.run(procedure, SETTING)

    def torque_free(self) -> bool:
        return self.world.tau == 0.0 and not self.instruments.drive.enabled  # type: ignore[attr-defined]


def test_a_procedure_that_ends_is_completed_and_brings_its_finding() -> None:
    bench = Bench()
    assert bench.run() == Ending("completed", "the procedure came to its end", Exit.PASS, "found")
    assert bench.torque_free()
    assert bench.supervisor.state is State.READY
    assert len(bench.sink.rows) == 2000  # 1999 commands after the first sample, and the last row with torque off
    assert bench.sink.rows[-1][1:3] == (0.0, 0.0)


def test_a_line_that_nobody_read_for_a_while_is_read_until_it_tells_something_new(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """While an operator was asked, or a drive took seconds to be enabled, it kept what is old and threw it away: the
    first look finds nothing of now, and a run must not trip on that."""
    bench, looks = Bench(), []
    sensor = bench.instruments.torque_sensor
    assert sensor is not None
    read, drive = sensor.read, bench.instruments.drive
    enable = drive.enable

    def slowly(mode: Mode) -> None:
        bench.world.clock.wait_until(bench.world.clock.t + 1.0)
        enable(mode)

    def unread() -> TorqueReading:
        looks.append(drive.enabled)  # type: ignore[attr-defined]
        first = looks.count(looks[-1]) == 1  # before the drive is enabled, and after
        return TorqueReading(bench.world.clock.t - 2.5, 0.0) if first else read()

    monkeypatch.setattr(sensor, "read", unread)
    monkeypatch.setattr(drive, "enable", slowly)
    bench.world.clock.wait_until(3.0)  # since they were connected
    assert bench.run().status == "completed"
    assert looks.count(False) >= 2
    assert looks.count(True) >= 2


def test_a_line_that_stays_silent_is_waited_for_a_moment_and_then_is_a_trip(monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench()
    monkeypatch.setattr(bench.instruments.torque_sensor, "read", lambda: TorqueReading(-2.5, 0.0))
    ending = bench.run()
    assert ending.status == "tripped"
    assert "no new torque-sensor sample" in ending.reason
    assert bench.world.clock.t < 1.0
    assert bench.torque_free()


@pytest.mark.parametrize(
    ("harm", "word"),
    [
        (lambda w: setattr(w, "fault", "over-current"), "over-current"),
        (lambda w: setattr(w, "silent_load", True), "no new load-encoder sample"),
        (lambda w: setattr(w, "omega", 100.0), "rpm"),
        (lambda w: setattr(w, "load_offset", 0.1), "disagree"),
        (lambda w: setattr(w, "tau_l", -49.0), "shaft torque"),
        (lambda w: setattr(w, "tau_l", float("nan")), "shaft torque"),
    ],
)
def test_a_trip_takes_the_torque_off_latches_and_marks_the_row(harm: Callable[[FakeWorld], None], word: str) -> None:
    bench = Bench()
    ending = bench.run(lambda: harm(bench.world))
    assert (ending.status, ending.exit) == ("tripped", Exit.TRIPPED)
    assert word in ending.reason
    assert bench.torque_free()
    assert bench.supervisor.state is State.FAULT
    assert bench.sink.rows[-1][0].flags & Flag.TRIPPED
    assert not any(row[0].flags & Flag.TRIPPED for row in bench.sink.rows[:-1])


def test_a_trip_is_told_once_the_torque_is_off_and_before_the_drive_confirmed_it() -> None:
    bench, told = Bench(), []
    bench.world.confirms = False  # and takes its time to be found out
    ending = bench.run(
        lambda: setattr(bench.world, "fault", "over-current"),
        tripped=lambda why: told.append((why, bench.torque_free(), bench.world.history.count("halt"))),
    )
    assert told == [("a device reports a fault: over-current", True, 1)]
    assert bench.world.history.count("halt") > 1
    assert "did not confirm" in ending.reason


@pytest.mark.parametrize("error", [RecorderError("rows are lost"), RuntimeError("a bug")])
def test_what_a_run_ends_with_says_when_the_stop_was_not_confirmed(error: Exception) -> None:
    bench = Bench()

    def at() -> None:
        bench.world.confirms = False
        raise error

    with pytest.raises(type(error)) as caught:
        bench.run(at)
    assert bench.supervisor.state is State.FAULT
    assert bench.supervisor.fault == f"{error}; {UNCONFIRMED}"
    assert caught.value.__notes__ == [f"{UNCONFIRMED}: {PRESS}"]


def test_a_driver_that_breaks_while_it_takes_the_torque_off_has_not_confirmed_it() -> None:
    bench = Bench()

    def broken() -> bool:
        raise BrokenPipeError(32, "Broken pipe")

    def at() -> None:
        bench.world.fault = "over-current"
        bench.instruments.drive.halt = bench.instruments.drive.cut = broken  # type: ignore[method-assign]

    ending = bench.run(at)
    assert (ending.status, ending.exit) == ("tripped", Exit.TRIPPED)
    assert ending.reason.endswith(f"{UNCONFIRMED} (BrokenPipeError: [Errno 32] Broken pipe)")
    assert bench.supervisor.state is State.FAULT


def test_a_motor_that_would_not_come_to_rest_is_not_said_to_have() -> None:
    bench = Bench()

    def at() -> None:
        bench.interrupts.request()
        bench.world.inertia = 5.0  # kg·m²: what braking takes off in two seconds is next to nothing

    ending = bench.run(at, tau=0.35)
    assert (ending.status, ending.exit) == ("stopped", Exit.STOPPED)
    assert "not brought to rest, it still turned at" in ending.reason
    assert re.search(r" rpm, torque off; the motor turns on at \d+ rpm without torque: keep clear", ending.reason)
    assert bench.torque_free()


def test_a_fault_latches_before_anybody_looks_whether_the_motor_turns_on(monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench()
    states: list[State] = []

    def turning(patience: float) -> float:
        states.append(bench.supervisor.state)
        return 50.0

    monkeypatch.setattr(bench.instruments, "still_turning", turning)

    def at() -> None:
        bench.world.fault = "over-current"

    ending = bench.run(at)
    assert states == [State.FAULT]
    assert "; the motor turns on at 477 rpm without torque" in ending.reason
    assert bench.supervisor.fault == ending.reason


def test_one_interrupt_brings_the_motor_to_rest_before_the_torque_goes() -> None:
    bench = Bench()
    ending = bench.run(bench.interrupts.request, tau=0.35)
    assert (ending.status, ending.exit) == ("stopped", Exit.STOPPED)
    assert abs(bench.sink.rows[-1][0].omega_m) < 0.1
    assert len(bench.sink.rows) < 1500
    assert bench.torque_free()


def test_a_hold_brings_the_motor_to_rest_and_keeps_it_there_until_a_stop() -> None:
    bench = Bench()
    bench.world.clock.at[2500] = bench.interrupts.request
    ending = bench.run(bench.interrupts.hold, tau=0.35)
    rows = [row[0] for row in bench.sink.rows]
    assert (ending.status, ending.exit) == ("stopped", Exit.STOPPED)
    assert len(rows) > 2400  # beyond the 2 s the procedure would have taken
    resting = [s.theta_m for s in rows[-1000:]]
    assert max(resting) - min(resting) < 0.01
    assert bench.torque_free()


@pytest.mark.parametrize(
    ("hold", "said"), [(False, "stopped by the operator"), (True, "stopped, and not held as asked")]
)
def test_a_stop_or_a_hold_before_the_signs_are_proven_closes_no_loop(hold: bool, said: str) -> None:
    """With the motor encoder the wrong way round the brake pushed on what it was to stop, for two seconds."""
    bench, proof = Bench(), SignAndScale(nudge_deg=90.0)  # far enough for the motor to be moving when it is asked for
    bench.world.motor_sign, bench.world.drag = -1.0, 0.05
    bench.world.clock.at[150] = bench.interrupts.hold if hold else bench.interrupts.stop
    guard = Guard(LIMITS, proof.envelope(SETTING), 50.0)
    loop = Loop(bench.instruments, bench.supervisor, guard, bench.sink, bench.interrupts, bench.timing)
    ending = loop.run(proof, SETTING)
    assert (ending.status, ending.exit) == ("stopped", Exit.STOPPED)
    assert ending.reason.startswith(said)
    assert "torque off at once and no braking, as sign-and-scale relies on no loop" in ending.reason
    assert bench.sink.rows[-1][0].omega_m < -0.5  # it moved, backwards as it seems
    assert len(bench.sink.rows) < 155
    assert min(row[2] for row in bench.sink.rows) >= 0.0  # nothing but the nudge
    assert bench.interrupts.count == 1  # a campaign starts nothing more
    assert bench.supervisor.state is State.READY


def test_a_stop_asked_for_before_a_hold_goes_before_it() -> None:
    bench = Bench()

    def both() -> None:
        bench.interrupts.request()
        bench.interrupts.hold()

    assert bench.run(both, tau=0.35).exit is Exit.STOPPED
    assert len(bench.sink.rows) < 1500


def test_two_interrupts_take_the_torque_off_at_once() -> None:
    bench = Bench()

    def twice() -> None:
        bench.interrupts.request()
        bench.interrupts.request()

    ending = bench.run(twice)
    assert (ending.status, ending.exit) == ("stopped", Exit.HALTED)
    assert len(bench.sink.rows) <= 502
    assert bench.torque_free()


@pytest.mark.parametrize(
    ("left", "said"),
    [
        (14.84, "; the shaft still carries +14.8 N·m: the gear is wound up or loaded, keep clear of it"),
        (-9.0, "; the shaft still carries -9.0 N·m: the gear is wound up or loaded, keep clear of it"),
        (1.0, ""),  # what friction leaves
    ],
)
def test_a_halt_of_a_wound_up_gear_says_how_much_torque_is_left(left: float, said: str) -> None:
    bench, told = Bench(), []
    bench.supervisor.announce = lambda state, act, why: told.append((state, why))

    def halt() -> None:
        bench.world.tau_l = left
        bench.interrupts.halt()

    ending = bench.run(halt)
    assert ending.reason == f"halted by the operator: torque off at once{said}"
    assert told[-1] == (State.READY, ending.reason)


WOUND = "the shaft still carries +14.8 N·m: the gear is wound up or loaded, keep clear of it"


def wound_up(bench: Bench, then: Callable[[], None] = lambda: None) -> Callable[[], None]:
    """A gear that carries torque from there on; `then` something happens."""

    def at() -> None:
        bench.world.tau_l = 14.84
        then()

    return at


def test_a_trip_of_a_wound_up_gear_says_how_much_torque_is_left() -> None:
    bench = Bench()
    ending = bench.run(wound_up(bench, lambda: setattr(bench.world, "fault", "over-current")))
    assert ending.reason == f"a device reports a fault: over-current; {WOUND}"
    assert bench.supervisor.fault == ending.reason


@pytest.mark.parametrize(
    "error", [NotReady("the load does not hold still"), RecorderError("disk full"), ValueError("")]
)
def test_an_error_under_a_wound_up_gear_says_how_much_torque_is_left(error: Exception) -> None:
    bench = Bench()

    def fail() -> None:
        raise error

    with pytest.raises(type(error)) as raised:
        bench.run(wound_up(bench, fail))
    assert raised.value.__notes__ == [WOUND]
    assert bench.supervisor.state is (State.READY if isinstance(error, NotReady) else State.FAULT)
    assert bench.supervisor.fault.endswith(WOUND) != isinstance(error, NotReady)


@pytest.mark.parametrize("confirms", [True, False])
def test_of_a_shaft_that_nobody_reads_any_more_the_last_torque_is_said(
    monkeypatch: pytest.MonkeyPatch, confirms: bool
) -> None:
    bench = Bench()
    monkeypatch.setattr(Instruments, "still_carried", lambda self, fresh: None)

    def silent() -> None:
        bench.world.fault, bench.world.confirms = "silent", confirms

    ending = bench.run(wound_up(bench, silent))
    said = WOUND.replace("still carries", "carried, when last heard of,")
    lost = "" if confirms else f"; {UNCONFIRMED}"
    assert ending.reason == f"a device reports a fault: silent{lost}; {said}"
    assert bench.supervisor.fault == ending.reason


@pytest.mark.parametrize(("tau", "flags"), [(float("inf"), Flag.SATURATED_TAU), (44.0, Flag.FROZEN_TAU)])
def test_a_torque_sensor_that_tells_nothing_of_now_is_not_believed_after_a_trip(
    tau: float, flags: Flag, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = Bench()
    look = Instruments.look
    monkeypatch.setattr(Instruments, "look", lambda self: look(self)._replace(tau_l=tau, flags=flags))
    ending = bench.run(lambda: setattr(bench.world, "fault", "over-current"))
    assert ending.reason == "a device reports a fault: over-current"


def test_a_bus_that_fails_after_the_torque_is_off_undoes_no_halt(monkeypatch: pytest.MonkeyPatch) -> None:
    bench = Bench()

    look = Instruments.look

    def gone(self: Instruments) -> Sample:
        if bench.interrupts.count:
            raise OSError("no such device")
        return look(self)

    monkeypatch.setattr(Instruments, "look", gone)
    ending = bench.run(bench.interrupts.halt)
    assert (ending.status, ending.exit) == ("stopped", Exit.HALTED)
    assert bench.torque_free()
    assert bench.supervisor.state is State.READY


@pytest.mark.parametrize("error", [NotReady("the load is locked"), RecorderError("disk full"), ValueError("a bug")])
def test_an_error_inside_a_procedure_leaves_no_torque(error: Exception) -> None:
    bench = Bench()

    def fail() -> None:
        raise error

    with pytest.raises(type(error)):
        bench.run(fail)
    assert bench.torque_free()
    assert bench.world.history[-1] == "halt"


def test_a_recorder_that_fails_ends_the_run_without_torque() -> None:
    bench = Bench()
    with pytest.raises(RecorderError, match="no space"):
        bench.run(lambda: setattr(bench.sink, "error", RecorderError("no space left")))
    assert bench.torque_free()
    assert bench.supervisor.state is State.FAULT


def test_a_drive_that_does_not_confirm_torque_off_is_a_fault_whatever_the_ending() -> None:
    bench = Bench()
    ending = bench.run(lambda: setattr(bench.world, "confirms", False))
    assert ending.exit is Exit.TRIPPED
    assert "did not confirm" in ending.reason
    assert bench.supervisor.state is State.FAULT


@pytest.mark.parametrize("running", [True, False])
def test_a_drive_lost_once_it_was_energised_is_a_trip_that_says_so(
    running: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = Bench()

    def lost(mode: Mode = Mode.TORQUE) -> None:
        bench.world.confirms = False
        raise NotReady("the drive does not answer")

    if not running:
        monkeypatch.setattr(bench.instruments.drive, "enable", lost)
    ending = bench.run(lost)
    assert (ending.status, ending.exit) == ("tripped", Exit.TRIPPED)
    assert ending.reason == f"the drive does not answer; {UNCONFIRMED}"
    assert bench.supervisor.fault == ending.reason


def test_a_drive_that_refuses_to_enable_is_never_commanded() -> None:
    bench = Bench()
    bench.world.fault = "under-voltage"
    with pytest.raises(HdrigError, match="under-voltage"):
        bench.run()
    assert bench.sink.rows == []
    assert bench.torque_free()


def test_a_device_that_breaks_as_it_is_opened_or_closed_leaves_no_other_open(monkeypatch: pytest.MonkeyPatch) -> None:
    bench, closed = Bench(), []
    sensor = bench.instruments.torque_sensor

    def broken() -> None:
        raise RuntimeError("a bug of a driver")

    monkeypatch.setattr(sensor, "connect", broken)
    monkeypatch.setattr(bench.instruments.load_encoder, "close", broken)
    monkeypatch.setattr(sensor, "close", lambda: closed.append("torque sensor"))
    with pytest.raises(RuntimeError, match="a bug of a driver"):
        bench.instruments.connect()
    assert bench.world.history == ["halt", "close"]  # of the drive, its torque off first
    assert closed == ["torque sensor"]


def test_time_counts_from_when_the_drive_was_enabled_however_long_it_took() -> None:
    """A reference of absolute time was 0.8 s away at the first tick."""
    bench, jog = Bench(), Jog(turns=0.2)
    enable = bench.instruments.drive.enable

    def slowly(mode: Mode = Mode.TORQUE) -> None:
        bench.world.clock.wait_until(bench.world.clock.now() + 0.8)
        enable(mode)

    bench.instruments.drive.enable = slowly  # type: ignore[method-assign]
    guard = Guard(LIMITS, jog.envelope(SETTING), 50.0)
    loop = Loop(bench.instruments, bench.supervisor, guard, bench.sink, bench.interrupts, bench.timing)
    assert loop.run(jog, SETTING).status == "completed"
    assert bench.sink.rows[0][0].t == pytest.approx(0.001)


def test_a_stop_asked_before_the_start_energises_nothing() -> None:
    bench = Bench()
    bench.interrupts.request()
    assert bench.run().exit is Exit.STOPPED
    assert "enable" not in bench.world.history
    assert bench.sink.rows == []


def test_a_torque_beyond_the_limit_is_recorded_as_asked_and_given_clipped() -> None:
    bench = Bench()
    bench.run(tau=50.0)
    asked, applied = bench.sink.rows[0][1:3]
    assert (asked, applied) == (50.0, 5.0)


def test_missed_cycles_are_counted_flagged_and_not_replayed() -> None:
    bench = Bench()
    bench.world.clock.late[100] = 0.0035
    bench.run()
    assert bench.timing.missed == 3
    assert bench.timing.late_events == 1
    flagged = [row[0] for row in bench.sink.rows if row[0].flags & Flag.MISSED]
    assert len(flagged) == 1
    gaps = [b[0].t - a[0].t for a, b in zip(bench.sink.rows, bench.sink.rows[1:], strict=False)]
    assert sum(g > 0.0015 for g in gaps) == 1


def test_lateness_quantiles_come_from_every_tick() -> None:
    timing = LoopTiming(0.001, virtual=False)
    for k in range(1000):
        timing.add(k * 1e-6)
    assert abs(timing.quantile(0.5) - 500e-6) < 2e-6
    assert abs(timing.quantile(0.99) - 990e-6) < 3e-6
    assert timing.summary()["lateness_max"] == pytest.approx(999e-6)


@pytest.mark.parametrize(
    ("held", "words"), [(0.0, []), (0.002, []), (0.006, ["this program itself was held up for 5.0 ms of it"])]
)
def test_stale_data_say_whether_the_program_itself_was_away_meanwhile(held: float, words: list[str]) -> None:
    bench = Bench()

    def strike() -> None:
        bench.world.silent_load = True
        bench.world.clock.t += held  # the first of it is the tick's own

    reason = bench.run(strike).reason
    assert "no new load-encoder sample for" in reason
    assert reason.split("; ")[1:] == words


@pytest.mark.parametrize(
    ("ago", "late", "words"),
    [
        (0.0, 0.168, "this program itself was held up for 105.5 ms of it (168.0 ms in all)"),
        (0.0, 0.1055, "this program itself was held up for 105.5 ms of it"),
        (0.0, 0.080, "this program itself was held up for 80.0 ms of it"),
        (0.040, 0.168, "this program itself was held up for 65.5 ms of it (168.0 ms in all)"),
        (0.060, 0.168, ""),  # most of it was before
    ],
)
def test_no_part_of_a_silence_is_told_as_longer_than_the_whole(ago: float, late: float, words: str) -> None:
    """A silence of 105.5 ms was said to be 168.0 ms of it."""
    bench = Bench()
    guard = Guard(LIMITS, Constant().envelope(SETTING), 50.0)
    loop = Loop(bench.instruments, bench.supervisor, guard, bench.sink, bench.interrupts, bench.timing)
    loop._skipped(10.0 - ago, late, 0.001)
    assert loop._held_up(10.0, 0.1055) == words


@pytest.mark.parametrize(("held", "ago", "told"), [(0.0, 0, False), (0.004, 20, False), (0.073, 20, True)])
def test_a_motor_that_lost_its_reference_says_whether_the_program_was_away_before(
    held: float, ago: int, told: bool
) -> None:
    """A stall of 73 ms was blamed on the gains."""
    bench = Bench()
    guard = Guard(LIMITS, Constant().envelope(SETTING), 50.0)
    loop = Loop(bench.instruments, bench.supervisor, guard, bench.sink, bench.interrupts, bench.timing)
    some = bench.instruments.read(10.0)
    if held:
        loop._skipped(10.0, held, 0.001)
    loop._skipped(10.0 + ago * 1e-3 / 2, 0.002, 0.001)  # a short one after it hides nothing
    lost = Trip("following", "motor 26.1° ahead of its reference")
    trip = loop._explained(lost, some, Torque(0.0), 10.0 + ago * 1e-3)
    assert ("this program itself was held up for 73.0 ms, 20 ms before" in trip.sentence) is told
    assert loop._explained(lost, some, Torque(0.0), 12.0) == lost
