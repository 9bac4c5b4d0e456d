"""One bench connected, from proof to a finished run folder."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Any

from rig.bench import Bench, ClockName
from rig.changes import judge_tare, refuse_turning, wait_for_rest
from rig.control.filter import SpeedFilter
from rig.core.devices import UNGUARDED
from rig.core.errors import Ended, HdrigError, NotReady
from rig.core.operator import Change, ClearFault, Operator, Rigging
from rig.core.procedure import Procedure
from rig.core.sample import Mode
from rig.guard import WOUND
from rig.procedures.sign_and_scale import Proof, SignAndScale
from rig.procedures.weigh import Weigh, Weighing
from rig.process.interrupts import Interrupts
from rig.refusals import refuse_beyond_limits, refuse_endless, refuse_mode, refuse_rigging
from rig.runfile.folder import create
from rig.runfile.room import refuse_no_room
from rig.session.changing import prepare, show
from rig.session.done import Done, Watch, nobody
from rig.session.log import SessionLog
from rig.session.manifest import manifest_of
from rig.session.observer import Observer
from rig.session.recording import Recording
from rig.supervisor import KEEP_CLEAR, UNCONFIRMED, Act, State, Supervisor
from rig.timing.ticks import LoopTiming


@dataclass
class Session:
    """One bench, connected. Use as a context manager; leaving it takes the torque off and lets go of the devices."""

    bench: Bench
    clock: ClockName
    root: Path
    interrupts: Interrupts
    note: str = ""
    hand: Operator | None = None  # the person who makes changes; the twin has a hand of its own
    rigging: Rigging = field(default_factory=Rigging)  # weight, lock pin, depth: as last shown by the sensors
    facts: dict[str, Any] = field(default_factory=dict)  # further keys of every manifest: the campaign a run belongs to
    create: Callable[[Path, str, dict[str, Any], str], Path] = create  # how run folders lie in `root`
    checks: str = ""  # folder within `root` for the runs that only show how the rig is
    observer: Observer = field(default_factory=Observer)  # who looks on: told of events and runs as they come
    unsure: str = ""  # the change that was asked for and not shown; no run until one is
    folder: Path | None = None  # of the newest run; None when it got none
    proof: Proof | None = None  # what sign-and-scale found since the last reset
    zero: Weighing | None = None  # what the unloaded torque sensor showed

    def __enter__(self) -> Session:
        self.log = SessionLog(self._run_time, self.observer)
        self.instruments = self.bench.open(self.clock)
        self.supervisor = Supervisor(self.log.announce, self.instruments.causes)
        try:
            self.identities = self.instruments.connect()
        except NotReady as error:
            if missing := self.bench.twin_not_there:
                error.add_note(missing)
            raise
        try:
            self._begin()
        except BaseException:
            self.instruments.close()
            raise
        return self

    def _begin(self) -> None:
        """What the devices say of themselves is told; from here a run may be asked for."""
        for device in self.instruments.devices:
            for remark in device.remarks:
                self.log.event("note", remark)
        if self.unguarded:
            self._warn(UNGUARDED)
        self.supervisor.act(Act.CONNECT)
        if self.simulated and not self.bench.simulated:
            self.observer.simulated(self.bench.file.name)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.instruments.close()
        self.supervisor.act(Act.DISCONNECT)

    @property
    def simulated(self) -> bool:
        """The bench is the twin, or a device says that it is the twin's, over whatever wire."""
        return self.bench.simulated or any(identity.simulated for identity in self.identities.values())

    @property
    def unguarded(self) -> bool:
        """Whether the drive would go on with its last torque should this program die."""
        watchdog = self.instruments.drive.watchdog
        return watchdog is not None and not watchdog.words

    def check(self, procedure: Procedure) -> None:
        """The bench can do what the procedure needs, and nothing turns. Raises NotReady: in fault, what is missing or
        too much, a motor that turns without torque; UsageError: no room on the disk for what it records; Ended.
        """
        if self.supervisor.state is State.FAULT:
            raise NotReady(
                f"the rig is in fault: {self.supervisor.fault}; see that it is whole and free to turn, then "
                f"`hdrig reset --bench {self.bench.source}`"
            )
        refuse_endless(self.bench, procedure)
        missing = [c for c in procedure.needs if c not in self.instruments.channels]
        if missing:
            raise NotReady(f"{self.bench.source} has no {' and no '.join(missing)}, which {procedure.title()} needs")
        refuse_beyond_limits(self.bench, procedure)
        refuse_no_room(self.root, self._rows(procedure), procedure.title())
        refuse_turning(self.instruments, self._refuse_now)

    def _warn(self, text: str) -> None:
        """Whoever looks on, and the next run's events."""
        self.log.event("note", text)
        self.observer.warned(text)

    def _wound_up(self) -> str | None:
        """That the shaft carries a torque which no weight explains, in words; None where it does not, or a rig that
        begins anew with each connection cannot."""
        limit, operator = self.bench.limits.shaft_torque, self.instruments.operator or self.hand
        if limit is None or (operator is not None and operator.begins_anew):
            return None
        carried = self.instruments.still_carried(self.bench.limits.stale)
        expected = (self.zero.torque if self.zero else 0.0) - self.rigging.tau_ext
        if carried is None or abs(carried - expected) <= WOUND * limit:
            return None
        return (
            f"before anything is energised the shaft carries {carried:+.1f} N·m, {expected:+.1f} N·m expected: the "
            f"gear is wound up, or something hangs there, {KEEP_CLEAR}"
        )

    def _rows(self, procedure: Procedure) -> float:
        """Most that it records, with the proof that has to come first."""
        proof = [SignAndScale()] if procedure.closes_loop and self.proof is None else []
        setting = self.bench.setting(lambda text: None)
        return sum(one.envelope(setting).duration for one in (*proof, procedure)) * self.bench.file.loop.rate

    def rewire(self, bench: Bench) -> None:
        """Go on with other gains and another speed filter; the devices stay as they are."""
        self.bench = bench
        self.instruments.speed_filter = SpeedFilter(bench.file.loop.speed_filter)

    def prove(self) -> Proof:
        """Sign-and-scale proof, recorded as a run of its own. Raises NotReady with what was measured."""
        procedure = SignAndScale()
        refuse_rigging(self.rigging, procedure)
        proof: Proof = self.finding(procedure)
        self.proof = proof
        return proof

    def tare(self) -> str:
        """Weigh the unloaded output: the torque sensor's zero, for the weights to come. Raises NotReady."""
        if self.rigging.tau_ext:
            raise NotReady(f"{self.rigging.tau_ext:+g} N·m hang on the output: the torque sensor is tared without")
        if self.proof is None:
            self.prove()
        found: Weighing = self.finding(Weigh())
        told = judge_tare(found, self.bench.limits.shaft_torque or math.inf)
        self.zero = found
        return told

    def tared(self) -> Weighing:
        """What the unloaded output weighs; weighed when it never was. Raises NotReady."""
        if self.zero is None:
            self.tare()
        assert self.zero is not None
        return self.zero

    def change(self, change: Change) -> str:
        """Torque off, at rest, asked for, made by hand, shown by the sensors; the sentence says what they showed.

        Raises NotReady: nobody to make it, it does not fit, or it cannot be seen; no run starts before one was.
        """
        operator = self._operator(change)
        prepare(self, change)
        self.come_to_rest()
        self.unsure = change.words()
        operator.make(change)
        self.come_to_rest()  # what was touched swings
        before, self.rigging = self.rigging, change.applied(self.rigging)
        try:
            shown = show(self, change)
        except HdrigError:
            self.rigging = before  # as last shown; `unsure` says that it may no longer be so
            raise
        self.unsure = ""
        return shown

    def clear_fault(self) -> None:
        """After a trip: somebody has looked, the fault is cleared, every check is made anew. Raises NotReady."""
        change = ClearFault(self.supervisor.fault)
        operator = self._operator(change)
        self.come_to_rest()
        operator.make(change)
        self.reset()

    def reset(self) -> None:
        """The explicit act that leaves a fault: every device looks anew, nothing is energised. Raises NotReady."""
        self.instruments.drive.reset_fault()
        if not self.instruments.safe():
            raise NotReady(f"the fault stays: {UNCONFIRMED}; press the hard-wired stop")
        for device in self.instruments.devices:
            device.clear()
        self.supervisor.act(Act.RESET)
        self.proof = None

    def restore(self, made: list[Change], rigging: Rigging) -> None:
        """Take up a rig that was left as `rigging`; on a twin, which begins anew, what was `made` is made again."""
        operator = self.instruments.operator or self.hand
        if operator is not None and operator.begins_anew:
            for change in made:
                operator.remake(change)
                self.come_to_rest()
        self.rigging = rigging

    def run(self, procedure: Procedure, watch: Watch = nobody) -> Done:
        """Run one procedure into a folder of its own. The folder is closed, with its status, on every way out."""
        if self.unsure:
            raise NotReady(f"what the rig is like is not known: '{self.unsure}' was asked for and could not be shown")
        refuse_rigging(self.rigging, procedure)
        refuse_mode(self.bench, procedure)
        return self._run(procedure, self.root, watch)

    def finding(self, procedure: Procedure) -> Any:
        """The finding of a run that others build on. Raises Ended when it came to no end."""
        done = self._run(procedure, self.root / self.checks, nobody)
        if done.ending.status != "completed":
            ended = Ended(f"the {procedure.title()} run did not finish: {done.ending.reason}", done.ending.exit)
            ended.add_note(f"what was recorded is in {done.folder}")
            raise ended
        return done.ending.finding

    def _run(self, procedure: Procedure, root: Path, watch: Watch) -> Done:
        self.folder = None
        if self.interrupts.let_hold_go():
            self.log.event("note", "a hold was asked for while nothing ran: there was nothing to hold")
        self.check(procedure)
        if (told := self._wound_up()) is not None:
            self._warn(told)
        self._refuse_now()
        if self.supervisor.state is State.CONNECTED:
            self.supervisor.act(Act.CHECK)
        mode = self._mode(procedure)
        folder = self.folder = self.create(root, procedure.name, manifest_of(self, procedure, mode), self.bench.text)
        timing = LoopTiming(1.0 / self.bench.file.loop.rate, virtual=self.clock == "virtual")
        self.log.open(folder)
        one = Recording(self.bench, self.instruments, self.supervisor, self.interrupts, self.log, timing, self.observer)
        try:
            return one.make(folder, procedure, mode, watch)
        finally:
            self.log.close()

    def come_to_rest(self) -> None:
        """Torque off and at rest, unless the operator asks for an end first. Raises NotReady, Ended."""
        wait_for_rest(self.instruments, self._refuse_now)

    def _refuse_now(self) -> None:
        """Raises Ended once the operator has asked for an end."""
        if self.interrupts.count:
            raise Ended(f"stopped {self.interrupts.who}; nothing more was started", self.interrupts.exit)

    def _mode(self, procedure: Procedure) -> Mode:
        """The bench's for a procedure that has a reference; proofs and checks ask for torques."""
        return self.bench.mode if procedure.has_reference else Mode.TORQUE

    def _operator(self, change: Change) -> Operator:
        operator = self.instruments.operator or self.hand
        if operator is None:
            raise NotReady(f"nobody is there who could do this: {change.words()}; start hdrig on a terminal")
        return operator

    def _run_time(self) -> float:
        return self.instruments.clock.now() - self.instruments.started
