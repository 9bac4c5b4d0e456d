"""One tick repeated: read, guard, decide, command, record. Every way out leaves the drive without torque first."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext, suppress
from dataclasses import dataclass, replace
from math import isfinite
from typing import Any, Protocol

from rig.control.setpoints import AsTorque, Setpoints
from rig.core.channels import Flag
from rig.core.clock import NEVER
from rig.core.errors import Exit, NotReady
from rig.core.procedure import Procedure, Setting, Steps
from rig.core.sample import Sample, Setpoint
from rig.core.units import RPM
from rig.guard import WOUND, Guard, Trip, stale
from rig.instruments import ENERGISED, TURNS, Instruments
from rig.process.interrupts import Interrupts
from rig.process.realtime import RealTime
from rig.supervisor import KEEP_CLEAR, PRESS, UNCONFIRMED, Act, State, Supervisor
from rig.timing.ticks import LoopTiming

MOSTLY = 0.5  # of the age of stale data: a program that was away for less is not why they are stale
AS_LONG = 0.8  # of the longest a channel may be silent: all that fell silent with the one that trips are named
TENTH_MS = 1e-4  # s: two times less apart than that are told as one
LONG = 0.01  # s without a command: by less no gains that hold a reference lose it
RECENT = 0.5  # s after which what a stall has done has swung out
LATCHES = 3  # in one tick at most: a machine that is away each time cannot run a loop
SETTLED = 0.3  # s after the torque is off: the load of a wound-up gear has swung by then
LET_GO = 1.5  # s after the torque is off: most motors rest by then, and of one that does not people have to know soon
WATCH_TICKS = 100  # how often the recorder's health and the operator's view are looked at


class Sink(Protocol):
    """Where rows go: the recorder, or a test's list."""

    def put(self, sample: Sample, tau_ask: float, tau_applied: float, theta_ref: float) -> None:
        """Keep one row; raises RecorderError when it cannot. The pair is speeds or angles when those are commanded."""

    def check(self) -> None:
        """Raises RecorderError when rows are no longer safe."""


@dataclass(frozen=True)
class Ending:
    """How a run ended, in the words of the manifest, and what the procedure found."""

    status: str  # completed | stopped | tripped
    reason: str
    exit: Exit
    finding: Any = None
    confirmed: bool = True  # by the drive: that its torque is off


class Loop:
    """Runs one procedure on one set of instruments, to whatever end."""

    def __init__(
        self,
        instruments: Instruments,
        supervisor: Supervisor,
        guard: Guard,
        sink: Sink,
        interrupts: Interrupts,
        timing: LoopTiming,
        watch: Callable[[Sample], None] = lambda sample: None,
        setpoints: Setpoints | None = None,
        tripped: Callable[[str], None] = lambda why: None,
    ) -> None:
        """`tripped` is told why between the command that takes the torque off and its confirmation, which a drive that
        is gone never gives: it is quick, and writes no file.
        """
        self.instruments = instruments
        self.supervisor = supervisor
        self.guard = guard
        self.sink = sink
        self.interrupts = interrupts
        self.timing = timing
        self.watch = watch
        self.setpoints = setpoints or AsTorque()
        self.tripped = tripped
        self.running = False
        self.away = (NEVER, 0.0)  # when this program last came back late, and how late [s]
        self.longest = (NEVER, 0.0)  # the same, of the longest time it was away of late
        self.rows = 0  # handed to the sink so far
        self.last_heard = 0.0  # N·m of the shaft, in the last row
        self.confirmed = True  # by the drive: that its torque is off, when the run was over

    def run(self, procedure: Procedure, setting: Setting) -> Ending:
        """Enable, tick until an end, disable. Raises HdrigError (a refusal by the procedure or of a drive that says its
        torque is off, a recorder that failed) only after the drive was made safe.
        """
        if self.interrupts.count:
            why = f"stopped {self.interrupts.who} before anything was energised"
            return Ending("stopped", why, self.interrupts.exit)
        try:
            # locking memory takes its time: done before anything is energised
            with nullcontext() if self.timing.virtual else RealTime() as real_time:
                self.timing.scheduling = real_time.granted if real_time else ""
                ending = self._energised(procedure, setting)
        except NotReady as error:
            if self.instruments.safe():
                self.supervisor.act(Act.FINISH if self.running else Act.TRIP, str(error))
                self._warn(error)
                raise
            ending = Ending("tripped", str(error), Exit.TRIPPED)  # energised and lost is more than not ready
        except BaseException as error:
            why = str(error) or repr(error)
            if not self.instruments.safe():
                why = self._unconfirmed(why)
                error.add_note(f"{UNCONFIRMED}: {PRESS}")
            self.supervisor.act(Act.TRIP, why)
            self._warn(error)
            raise
        finally:
            self.confirmed = self.instruments.safe()
            self.timing.offsets = self.instruments.told()
        return self._leave(ending)

    def _energised(self, procedure: Procedure, setting: Setting) -> Ending:
        try:
            self.instruments.wake(self.guard.limits.stale)
            self.instruments.start()  # for the events meanwhile
            self.supervisor.act(Act.ENABLE)
            self.instruments.drive.enable(self.setpoints.mode)
            self.instruments.wake(self.guard.limits.stale, ENERGISED)  # a drive may take seconds
            self.instruments.start()  # and the references of a run go by its time
            self.supervisor.act(Act.RUN, procedure.title())
            self.running = True
            return self._tick(procedure, setting)
        except BaseException:
            self.instruments.safe()  # before anything else, giving memory and priority back included
            raise

    def _tick(self, procedure: Procedure, setting: Setting) -> Ending:
        clock, read, write = self.instruments.clock, self.instruments.read, self.instruments.write
        latch = self.instruments.latch
        check, allowed, put, late = self.guard.check, self.guard.allowed, self.sink.put, self.timing.add
        interrupts = self.interrupts
        period, start, k = setting.period, clock.now(), 0
        steps: Steps = self.setpoints.steps(procedure, setting)
        asked: Setpoint = next(steps)
        while True:
            k += 1
            deadline = start + k * period
            now = clock.wait_until(deadline) if latch is None else self._latched(latch, deadline, period)
            lateness = now - deadline
            late(lateness if lateness > 0.0 else 0.0)
            skipped = 0
            if lateness > period:
                skipped = self._skipped(now, lateness, period)
                k += skipped
            sample = read(now)
            if skipped:
                sample = sample._replace(flags=sample.flags | Flag.MISSED)
            trip = check(sample, asked)
            if trip is not None:
                return self._tripped(trip, sample, asked, now)
            ends = interrupts.count
            if ends > 1:
                return self._halted(sample, asked)
            if ends or interrupts.held:
                if not procedure.closes_loop:
                    return self._let_go(sample, asked, procedure)
                steps = self._course(steps, procedure, setting)
            try:
                asked = steps.send(sample)
            except NotReady:
                self.instruments.safe()
                self._last_row(sample, asked)  # the sample it refused on is part of the run
                raise
            except StopIteration as end:
                return self._ended(sample, asked, end.value)
            put(sample, asked[0], write(allowed(asked)), asked.theta_ref)
            self.rows += 1
            if k % WATCH_TICKS == 0:
                self.sink.check()
                self.watch(sample)

    def _skipped(self, now: float, lateness: float, period: float) -> int:
        """How many ticks this program was away for."""
        skipped = int(lateness / period)
        self.timing.skip(skipped)
        self.away = (now, lateness)
        if lateness >= self.longest[1] or now - self.longest[0] > RECENT:
            self.longest = self.away
        return skipped

    def _tripped(self, trip: Trip, sample: Sample, asked: Setpoint, now: float) -> Ending:
        self.instruments.cut()  # before any word about it is made
        trip = self._explained(trip, sample, asked, now)
        self.tripped(trip.sentence)
        self.instruments.safe()
        self._last_row(sample._replace(flags=sample.flags | Flag.TRIPPED), asked)
        return Ending("tripped", trip.sentence, Exit.TRIPPED)

    def _halted(self, sample: Sample, asked: Setpoint) -> Ending:
        self.instruments.safe()  # before any word about it is written down
        self._last_row(sample, asked)
        return Ending("stopped", f"halted {self.interrupts.who}: torque off at once", Exit.HALTED)

    def _let_go(self, sample: Sample, asked: Setpoint, procedure: Procedure) -> Ending:
        """A stop, or a hold, of a run that relies on no loop: torque off at once (category 0). Braking and holding are
        loops, and over a sign that nobody has proven they drive the motor on.
        """
        self.instruments.safe()  # before any word about it is written down
        self._last_row(sample, asked)
        who, end = self.interrupts.who, "stopped"
        if not self.interrupts.count:
            end = "stopped, and not held as asked,"
            self.interrupts.stop()  # whoever asked for a hold wants nothing more to be started
        self.supervisor.act(Act.STOP, f"asked {who}: torque off at once")
        why = f"{end} {who}: torque off at once and no braking, as {procedure.title()} relies on no loop"
        return Ending("stopped", f"{why}{self._turns_on(sample)}", Exit.STOPPED)

    def _ended(self, sample: Sample, asked: Setpoint, finding: Any) -> Ending:
        """The procedure is through, or the motor was brought to rest as the operator asked."""
        self.instruments.safe()
        self._last_row(sample, asked)
        if self.supervisor.state is State.STOPPING:
            why = f"stopped {self.interrupts.who}: {self._at_rest(sample)}, torque off{self._turns_on(sample)}"
            return Ending("stopped", why, Exit.STOPPED)
        return Ending("completed", "the procedure came to its end", Exit.PASS, finding)

    @staticmethod
    def _at_rest(sample: Sample) -> str:
        """Whether the motor was brought to rest: one that would not come is let go."""
        if abs(sample.omega_m) < TURNS:
            return "brought to rest"
        return f"not brought to rest, it still turned at {sample.omega_m / RPM:.0f} rpm"

    def _course(self, steps: Steps, procedure: Procedure, setting: Setting) -> Steps:
        """What is stepped on with: something else once the operator has asked for a hold or a stop."""
        state = self.supervisor.state
        if self.interrupts.count and state is not State.STOPPING:
            self.supervisor.act(Act.STOP, f"asked {self.interrupts.who}")
            steps = self.setpoints.to_rest(procedure, setting)
            next(steps)
        elif self.interrupts.held and state is State.RUNNING:
            self.supervisor.act(Act.HOLD, "asked by the operator")
            steps = self.setpoints.hold(setting)
            next(steps)
        return steps

    def _latched(self, latch: Callable[[], None], deadline: float, period: float) -> float:
        """Devices latch `lead` before the deadline; the time [s] when their answers are in.

        Who woke late still gives them their time, or would read the reading before; who was away between latching and
        reading latches again, a few times: what was latched is old by then.
        """
        wait, lead = self.instruments.clock.wait_until, self.instruments.lead
        woken = wait(deadline - lead)
        for _ in range(LATCHES):
            latch()
            now = wait(max(deadline, woken + lead))
            if now - woken <= lead + period:
                break
            woken = now
        return now

    def _explained(self, trip: Trip, sample: Sample, asked: Setpoint, now: float) -> Trip:
        """Data too old to act on: whose, and where a device tells one thing and not the other, which it is. A motor
        that lost its reference: whether nobody led it for a while."""
        if trip.name == "following" and (words := self._stalled(now)):
            return trip._replace(sentence=f"{trip.sentence}; {words}")
        if trip.name != "stale":
            return trip
        late = self.instruments.overdue(now, AS_LONG * self.guard.limits.stale)
        trip = stale(self.guard, sample._replace(flags=late), asked) or trip
        told = [words for words in (self.instruments.silent(), self._held_up(now, sample.age)) if words]
        return trip._replace(sentence="; ".join([trip.sentence, *told]))

    def _held_up(self, now: float, age: float) -> str:
        """That this program itself was away for most of the last `age` s: its devices may have spoken meanwhile. It may
        have been away longer than that: what was read last had come while it was.
        """
        back, late = self.away
        part = min(late, back - (now - age))
        if part <= MOSTLY * age:
            return ""
        more = f" ({late * 1e3:.1f} ms in all)" if late > part + TENTH_MS else ""
        return f"this program itself was held up for {part * 1e3:.1f} ms of it{more}"

    def _stalled(self, now: float) -> str:
        """That this program itself was away so long a while ago that the motor may have lost its reference by it."""
        back, late = self.longest
        if late < LONG or now - back > RECENT:
            return ""
        return (
            f"but this program itself was held up for {late * 1e3:.1f} ms, {(now - back) * 1e3:.0f} ms before, which "
            "alone may have done it: is the machine busy with something else?"
        )

    def _last_row(self, sample: Sample, asked: Setpoint) -> None:
        """What was seen when the torque had just been taken off."""
        if isfinite(sample.tau_l):
            self.last_heard = sample.tau_l
        self.sink.put(sample, self.setpoints.off, self.setpoints.off, asked.theta_ref)
        self.rows += 1

    def _warn(self, error: BaseException) -> None:
        """What is still there goes with an error, and with the fault that it latched. Never raises."""
        if seen := self._still_there():
            error.add_note(seen.removeprefix("; "))
            if self.supervisor.state is State.FAULT:
                self.supervisor.amend(seen)

    def _still_there(self) -> str:
        """What keeps turning or stays wound up though the motor gives no torque, in words for who walks up to it; ""
        where nothing is seen of either. Never raises.
        """
        return self._wound_up() + self._turns_on()

    def _wound_up(self) -> str:
        """That the shaft carries torque though the motor gives none, as of a gear let go while it was wound up, in
        words; "" where nothing is seen of it. Never raises: the torque is off, and no bus that fails now undoes a halt.
        """
        limit = self.guard.limits.shaft_torque
        if limit is None:
            return ""
        carries, left = "still carries", None
        with suppress(Exception):  # nothing is known of the shaft now
            self.instruments.clock.wait_until(self.instruments.clock.now() + SETTLED)
            left = self.instruments.still_carried(self.guard.limits.stale)
        if left is None:
            carries, left = "carried, when last heard of,", self.last_heard
        if not abs(left) > WOUND * limit:
            return ""
        return f"; the shaft {carries} {left:+.1f} N·m: the gear is wound up or loaded, {KEEP_CLEAR}"

    def _turns_on(self, last: Sample | None = None) -> str:
        """That the motor turns on without its torque, in words; "" where it comes to rest, as after a `last` sample
        that was, or where nothing is seen of it. Never raises, as the torque is off.
        """
        if last is not None and abs(last.omega_m) < TURNS:
            return ""
        speed = 0.0
        with suppress(Exception):  # nothing is known of the motor then
            speed = self.instruments.still_turning(LET_GO)
        if not speed:
            return ""
        return (
            f"; the motor turns on at {speed / RPM:.0f} rpm without torque: {KEEP_CLEAR}; where a weight drives "
            "it, hold the output and take that off"
        )

    def _unconfirmed(self, why: str) -> str:
        """A reason, and that there may be torque still."""
        broken = f" ({self.instruments.broken})" if self.instruments.broken else ""
        return f"{why}; {UNCONFIRMED}{broken}"

    def _leave(self, ending: Ending) -> Ending:
        if not self.confirmed:
            why = self._unconfirmed(ending.reason)
            self.supervisor.act(Act.TRIP, why)
            if seen := self._wound_up():
                self.supervisor.amend(seen)
            return Ending("tripped", f"{why}{seen}", Exit.TRIPPED, ending.finding, confirmed=False)
        if ending.status == "tripped":
            self.supervisor.act(Act.TRIP, ending.reason)  # latched before anything is looked at
            if seen := self._still_there():
                ending = replace(ending, reason=f"{ending.reason}{seen}")
                self.supervisor.amend(seen)
        elif ending.exit is Exit.HALTED:
            ending = replace(ending, reason=f"{ending.reason}{self._still_there()}")
            self.supervisor.act(Act.HALT, ending.reason)
        else:
            self.supervisor.act(Act.FINISH, ending.reason)
        return ending
