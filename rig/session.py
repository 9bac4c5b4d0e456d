"""From connect to a finished run folder: one bench opened, proven, run. On every way out torque first, files second."""

from __future__ import annotations

import contextlib
import math
import platform
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Any

from rig.bench import Bench, ClockName
from rig.changes import (
    band_at_rest,
    judge_free,
    judge_lock,
    judge_tare,
    judge_weight,
    refuse_driving,
    refuse_unfit,
    wait_for_rest,
)
from rig.control.filter import SpeedFilter
from rig.control.setpoints import setpoints_of
from rig.core.errors import Exit, HdrigError, NotReady, RecorderError
from rig.core.operator import Change, ClearFault, FreeOutput, HangWeight, LockOutput, Operator, Reassemble, Rigging
from rig.core.procedure import Procedure
from rig.core.sample import Mode, Sample
from rig.guard import Guard
from rig.interrupts import Interrupts
from rig.loop import Ending, Loop
from rig.procedures.lock_check import LockCheck
from rig.procedures.sign_and_scale import Proof, SignAndScale
from rig.procedures.unwind import Unwind
from rig.procedures.weigh import Weigh, Weighing
from rig.recorder import Recorder
from rig.refusals import refuse_beyond_limits, refuse_endless, refuse_mode, refuse_rigging
from rig.runfile.events import EventLog
from rig.runfile.finalise import finalise
from rig.runfile.folder import create
from rig.software import operator, software
from rig.supervisor import Act, State, Supervisor
from rig.timing import LoopTiming

LET_OUT = 3.0  # N·m wound up in a locked gear: more is let out before anybody pulls the pin
Watch = Callable[[Sample], None]


@dataclass(frozen=True)
class Done:
    """A run that came to an end, its folder closed."""

    folder: Path
    ending: Ending


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
    unsure: str = ""  # the change that was asked for and not shown; no run until one is
    folder: Path | None = None  # of the newest run; None when it got none
    _proof: Proof | None = None
    _tare: Weighing | None = None
    _early: list[tuple[str, str]] = field(default_factory=list)  # events before there is a folder for them
    _log: EventLog | None = None

    def __enter__(self) -> Session:
        self.instruments = self.bench.open(self.clock)
        self.supervisor = Supervisor(self._announce, self.instruments.causes)
        self.identities = self.instruments.connect()
        for device in self.instruments.devices:
            for remark in device.remarks:
                self._event("note", remark)
        self.supervisor.act(Act.CONNECT)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.instruments.close()
        self.supervisor.act(Act.DISCONNECT)

    def check(self, procedure: Procedure) -> None:
        """The bench can do what the procedure needs. Raises NotReady with what is missing or too much."""
        refuse_endless(self.bench, procedure)
        missing = [c for c in procedure.needs if c not in self.instruments.channels]
        if missing:
            raise NotReady(f"{self.bench.source} has no {' and no '.join(missing)}, which {procedure.title()} needs")
        refuse_beyond_limits(self.bench, procedure)

    def rewire(self, bench: Bench) -> None:
        """Go on with other gains and another speed filter; the devices stay as they are."""
        self.bench = bench
        self.instruments.speed_filter = SpeedFilter(bench.file.loop.speed_filter)

    def prove(self) -> Proof:
        """Sign-and-scale proof, recorded as a run of its own. Raises NotReady with what was measured."""
        procedure = SignAndScale()
        refuse_rigging(self.rigging, procedure)
        proof: Proof = self._found(procedure)
        self._proof = proof
        return proof

    def tare(self) -> str:
        """Weigh the unloaded output: the torque sensor's zero, for the weights to come. Raises NotReady."""
        if self.rigging.tau_ext:
            raise NotReady(f"{self.rigging.tau_ext:+g} N·m hang on the output: the torque sensor is tared without")
        if self._proof is None:
            self.prove()
        found: Weighing = self._found(Weigh())
        told = judge_tare(found, self.bench.limits.shaft_torque or math.inf)
        self._tare = found
        return told

    def _tared(self) -> Weighing:
        if self._tare is None:
            self.tare()
        assert self._tare is not None
        return self._tare

    def change(self, change: Change) -> str:
        """Torque off, at rest, asked for, made by hand, shown by the sensors; the sentence says what they showed.

        Raises NotReady: nobody to make it, it does not fit, or it cannot be seen; no run starts before one was.
        """
        operator = self._operator(change)
        self._prepare(change)
        wait_for_rest(self.instruments)
        self.unsure = change.words()
        operator.make(change)
        wait_for_rest(self.instruments)  # what was touched swings
        before, self.rigging = self.rigging, change.applied(self.rigging)
        try:
            shown = self._show(change)
        except HdrigError:
            self.rigging = before  # as last shown; `unsure` says that it may no longer be so
            raise
        self.unsure = ""
        return shown

    def clear_fault(self) -> None:
        """After a trip: somebody has looked, the fault is cleared, every check is made anew. Raises NotReady."""
        change = ClearFault(self.supervisor.fault)
        operator = self._operator(change)
        wait_for_rest(self.instruments)
        operator.make(change)
        self.reset()

    def reset(self) -> None:
        """The explicit act that leaves a fault: every device looks anew, nothing is energised. Raises NotReady."""
        self.instruments.drive.reset_fault()
        for device in self.instruments.devices:
            device.clear()
        self.supervisor.act(Act.RESET)
        self._proof = None

    def restore(self, made: list[Change], rigging: Rigging) -> None:
        """Take up a rig that was left as `rigging`; on a twin, which begins anew, what was `made` is made again."""
        if self.instruments.operator is not None:
            for change in made:
                self.instruments.operator.make(change)
                wait_for_rest(self.instruments)
        self.rigging = rigging

    def _operator(self, change: Change) -> Operator:
        operator = self.instruments.operator or self.hand
        if operator is None:
            raise NotReady(f"nobody is there who could do this: {change.words()}; start hdrig on a terminal")
        return operator

    def _prepare(self, change: Change) -> None:
        """Whatever has to be known or undone before anybody touches the rig. Raises NotReady when it does not fit."""
        refuse_unfit(change, self.rigging, self.bench.limits.shaft_torque)
        match change:
            case HangWeight(tau_ext) if tau_ext:
                refuse_driving(tau_ext, self.bench.file.gear.N, self._tared().drag)
            case LockOutput() if self._proof is None:
                self.prove()
            case FreeOutput() if abs(self._wound_up()) > LET_OUT:
                self._found(Unwind())

    def _wound_up(self) -> float:
        """N·m at the torque sensor, at rest; 0 without a sensor."""
        wait_for_rest(self.instruments)
        tau = self.instruments.read(self.instruments.clock.now()).tau_l
        return 0.0 if math.isnan(tau) else tau

    def _show(self, change: Change) -> str:
        """What the sensors say of a change. Raises NotReady when it is not what was asked for."""
        match change:
            case HangWeight(tau_ext):
                if self._tare is None:  # taken off before it was known what nothing weighs
                    return self.tare()
                zero, band = self._tare.torque, band_at_rest(tau_ext, self._tare.friction)
                return judge_weight(self._found(Weigh(tau_ext, zero, band)), tau_ext, zero)
            case LockOutput():
                check = LockCheck()
                return judge_lock(self._found(check), math.radians(check.angle_deg))
            case Reassemble() if (
                self.instruments.torque_sensor is not None
            ):  # what was taken apart has a zero of its own
                return f"{self.prove().sentence}; {self.tare()}"
            case FreeOutput():  # gently: a pin that is still in would let a whole turn wind the gear up
                return f"{judge_free(self._found(LockCheck()))}; {self.prove().sentence}"
            case _:  # turns, and the output follows by the ratio
                return self.prove().sentence

    def _found(self, procedure: Procedure) -> Any:
        """The finding of a run that others build on. Raises Ended when it came to no end."""
        done = self._run(procedure, self.root / self.checks)
        if done.ending.status != "completed":
            raise Ended(f"the {procedure.title()} run did not finish: {done.ending.reason}", done.ending.exit)
        return done.ending.finding

    def run(self, procedure: Procedure, watch: Watch = lambda sample: None) -> Done:
        """Run one procedure into a folder of its own. The folder is closed, with its status, on every way out."""
        if self.unsure:
            raise NotReady(f"what the rig is like is not known: '{self.unsure}' was asked for and could not be shown")
        refuse_rigging(self.rigging, procedure)
        refuse_mode(self.bench, procedure)
        return self._run(procedure, self.root, watch)

    def _mode(self, procedure: Procedure) -> Mode:
        """The bench's for a procedure that has a reference; proofs and checks ask for torques."""
        return self.bench.mode if procedure.has_reference else Mode.TORQUE

    def _run(self, procedure: Procedure, root: Path, watch: Watch = lambda sample: None) -> Done:
        self.folder = None
        self.check(procedure)
        if self.supervisor.state is State.FAULT:
            raise NotReady(
                f"the rig is in fault: {self.supervisor.fault}; see that it is whole and free to turn, then "
                f"`hdrig reset --bench {self.bench.source}`"
            )
        if self.interrupts.count:
            raise Ended("stopped by the operator; nothing more was started", self.interrupts.exit)
        if self.supervisor.state is State.CONNECTED:
            self.supervisor.act(Act.CHECK)
        folder = self.folder = self.create(root, procedure.name, self._manifest(procedure), self.bench.text)
        timing = LoopTiming(1.0 / self.bench.file.loop.rate, virtual=self.clock == "virtual")
        self._log = EventLog(folder)
        for kind, text in self._early:
            self._log.write(kind, text)
        self._early.clear()
        try:
            return self._record(folder, procedure, timing, watch)
        finally:
            self._end_log()

    def _record(self, folder: Path, procedure: Procedure, timing: LoopTiming, watch: Watch) -> Done:
        recorder = Recorder(folder, self.instruments.clock, interrupted=lambda: self.interrupts.count > 0)
        recorder.start()
        setting = self.bench.setting(lambda text: self._event("note", text))
        guard = Guard(self.bench.limits, procedure.envelope(setting), setting.ratio)
        setpoints = setpoints_of(self._mode(procedure), setting)
        loop = Loop(self.instruments, self.supervisor, guard, recorder, self.interrupts, timing, watch, setpoints)
        ending, problem = Ending("interrupted", "an internal error ended the run", Exit.INTERNAL), ""
        try:
            ending = loop.run(procedure, setting)
        except HdrigError as error:
            ending = Ending("tripped" if error.exit is Exit.TRIPPED else "stopped", str(error), error.exit)
            raise
        finally:
            # the loop has made the drive safe, whatever happened; only now files
            problem = self._close(recorder, folder, ending, timing, loop.rows)
            if problem:
                print(f"hdrig: {problem}", file=sys.stderr)
        if problem:
            raise Ended(f"{ending.reason}; but {problem}", ending.exit or Exit.INCOMPLETE)
        return Done(folder, ending)

    def _close(self, recorder: Recorder, folder: Path, ending: Ending, timing: LoopTiming, rows: int) -> str:
        """Every row to disk, then the run closed; a sentence where that fails: the rows then stay where they are."""
        if ending.finding is not None:
            self._event("finding", str(getattr(ending.finding, "sentence", ending.finding)))
        try:
            # what the recorder could not write is in the ring: closing the run tries again
            with contextlib.suppress(RecorderError):
                recorder.close()
            self._end_log()  # its hash is taken next: nothing may be added after
            summary, code = timing.summary(), int(ending.exit)
            closed = finalise(folder, ending.status, ending.reason, timing=summary, expected_rows=rows, exit=code)
        except HdrigError as error:
            return f"{error}; hdrig recover {folder} tries again"
        return f"{closed.lost} of {rows} rows of {folder} are lost" if closed.lost else ""

    def _end_log(self) -> None:
        if self._log is not None:
            self._log.close()
            self._log = None

    def _announce(self, state: State, act: Act, why: str) -> None:
        kind = {Act.TRIP: "trip", Act.HOLD: "operator", Act.STOP: "operator", Act.HALT: "operator"}.get(act, "state")
        self._event(kind, f"{state}: {why}" if why else str(state))

    def _event(self, kind: str, text: str) -> None:
        if self._log is None:
            self._early.append((kind, text))
            return
        with contextlib.suppress(HdrigError):  # a full disk shows in the rows; it must not stand in the way of a stop
            self._log.write(kind, text, self._run_time())

    def _run_time(self) -> float:
        return self.instruments.clock.now() - self.instruments.started

    def _manifest(self, procedure: Procedure) -> dict[str, Any]:
        manifest = self.bench.manifest()
        conditions = {**procedure.conditions(), **self.rigging.conditions()}
        if self.note:
            conditions["note"] = self.note
        simulated = any(identity.simulated for identity in self.identities.values())
        return {
            **manifest,
            # the twin over a real wire is a simulation all the same
            "backend": "sim" if simulated else manifest["backend"],
            "transport": manifest["backend"],
            **self.facts,
            "conditions": conditions,
            "label": procedure.label or None,
            "devices": {name: identity._asdict() for name, identity in self.identities.items()},
            "proof": self._proof._asdict() if self._proof else None,
            "loop": {"rate": self.bench.file.loop.rate, "clock": self.clock, "mode": str(self._mode(procedure))},
            "software": software(),
            "host": platform.node(),
            "operator": operator(),
        }


class Ended(HdrigError):
    """A run that others build on was ended by the guard or the operator: its exit code is the command's."""

    def __init__(self, sentence: str, exit: Exit) -> None:
        super().__init__(sentence)
        self.exit = exit
