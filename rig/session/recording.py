"""One procedure through the loop into its folder. On every way out torque first, files second."""

from __future__ import annotations

import contextlib
import sys
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from rig.bench import Bench
from rig.control.setpoints import setpoints_of
from rig.core.errors import Ended, Exit, HdrigError, RecorderError, with_notes
from rig.core.procedure import Procedure, Setting
from rig.core.sample import Mode, Sample
from rig.guard import Guard
from rig.instruments import Instruments
from rig.loop import Ending, Loop
from rig.process.interrupts import Interrupts
from rig.recorder import Recorder
from rig.runfile.finalise import finalise
from rig.session.behind import PATIENCE
from rig.session.done import Done, Watch
from rig.session.log import SessionLog
from rig.session.observer import Begun, Observer
from rig.supervisor import Supervisor
from rig.timing.ticks import LoopTiming


@dataclass(frozen=True)
class Recording:
    """What one run needs of its session."""

    bench: Bench
    instruments: Instruments
    supervisor: Supervisor
    interrupts: Interrupts
    log: SessionLog
    timing: LoopTiming
    observer: Observer

    def make(self, folder: Path, procedure: Procedure, mode: Mode, watch: Watch) -> Done:
        """Run it and close its folder, with its status, on every way out.

        Raises Ended when rows are lost, and what the loop raises once the drive is safe.
        """
        recorder: Recorder | None = None
        ending, problem = Ending("interrupted", "an internal error ended the run", Exit.INTERNAL), ""
        rows, confirmed = 0, True
        failed: HdrigError | None = None
        try:
            recorder = Recorder(folder, self.instruments.clock, interrupted=lambda: self.interrupts.count > 0)
            recorder.start()
            loop = self._loop(recorder, folder, procedure, mode, watch)
            try:
                ending = loop.run(procedure, self._setting)
            finally:
                rows, confirmed = loop.rows, loop.confirmed
        except HdrigError as error:
            status = "tripped" if error.exit is Exit.TRIPPED else "stopped"
            ending = Ending(status, with_notes(error), error.exit, confirmed=confirmed)
            failed = error
            raise
        finally:
            # the loop has made the drive safe, whatever happened; only now files
            try:
                self._tell(folder, ending)
            finally:  # whatever becomes of an observer
                problem = self._close(recorder, folder, ending, rows)
                if problem:
                    print(f"hdrig: {problem}", file=sys.stderr)
                if failed is not None:  # no report follows by itself
                    report = f"; hdrig analyse {folder} makes its report" if rows and not problem else ""
                    failed.add_note(f"what was recorded is in {folder}{report}")
        if problem:
            raise Ended(f"{ending.reason}; but {problem}", ending.exit or Exit.INCOMPLETE)
        return Done(folder, ending)

    @cached_property
    def _setting(self) -> Setting:
        return self.bench.setting(lambda text: self.log.event("note", text))

    def _loop(self, recorder: Recorder, folder: Path, procedure: Procedure, mode: Mode, watch: Watch) -> Loop:
        envelope = procedure.envelope(self._setting)
        begun = Begun(folder, procedure, envelope.duration, recorder.ring, self.timing)
        return Loop(
            self.instruments, self.supervisor, Guard(self.bench.limits, envelope, self._setting.ratio), recorder,
            self.interrupts, self.timing, self._both(watch, self.observer.begun(begun)),
            setpoints_of(mode, self._setting), self.log.tripped,
        )  # fmt: skip

    @staticmethod
    def _both(watch: Watch, other: Watch) -> Watch:
        def watches(sample: Sample) -> None:
            watch(sample)
            other(sample)

        return watches

    def _tell(self, folder: Path, ending: Ending) -> None:
        self.observer.ended(folder, ending)
        if ending.finding is not None:
            self.log.event("finding", _found(ending))

    def _close(self, recorder: Recorder | None, folder: Path, ending: Ending, rows: int) -> str:
        """Every row to disk, then the run closed; a sentence where that fails: the rows then stay where they are. No
        `recorder`: there was no memory for its ring, and nothing was energised."""
        facts: dict[str, Any] = {"exit": int(ending.exit)}
        if ending.finding is not None:
            facts["finding"] = _found(ending)
        try:
            # what the recorder could not write is in the ring: closing the run tries again
            if recorder is not None:
                with contextlib.suppress(RecorderError):
                    recorder.close()
            whole = self.log.close()  # its hash is taken next: nothing may be added after
            summary = self.timing.summary()
            closed = finalise(folder, ending.status, ending.reason, timing=summary, expected_rows=rows, **facts)
        except HdrigError as error:
            return f"{error}; hdrig recover {folder} tries again"
        lost = f"{closed.lost} of {rows} rows of {folder} are lost" if closed.lost else ""
        late = "" if whole else f"the last events of {folder} are missing: its disk did not take them in {PATIENCE:g} s"
        return "; ".join(filter(None, (lost, late)))


def _found(ending: Ending) -> str:
    """What the procedure found, in a sentence where it has one."""
    return str(getattr(ending.finding, "sentence", ending.finding))
