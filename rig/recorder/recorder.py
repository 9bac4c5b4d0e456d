"""The loop's end of the recorder: starts the process, hands over rows, watches that they are being kept."""

from __future__ import annotations

import contextlib
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from rig.core.clock import Clock
from rig.core.errors import HdrigError, RecorderError
from rig.core.ring import CAPACITY, Ring
from rig.core.sample import Sample
from rig.runfile import manifest
from rig.runfile.journal import rows_missing
from rig.runfile.process import this_process

READY_WITHIN = 20.0  # s of wall time for a process to start; 0.15 s on a quiet machine
STUCK = 30.0  # s of wall time for a full ring to be given any room: a disk that takes longer will not come back
STUCK_WHEN_ASKED = 2.0  # s of it when somebody asked the program to end: ten times what lies between two batches
DONE_WITHIN = 60.0  # s for what is left in the ring, at most 7 MB, to reach the disk


class Recorder:
    """Keeps the rows of one run in `folder`. `start`, then `put` every tick and `check` now and then, then `close`."""

    def __init__(
        self,
        folder: Path,
        clock: Clock,
        capacity: int = CAPACITY,
        interrupted: Callable[[], bool] = lambda: False,
    ) -> None:
        """`capacity` is how many rows may wait for the disk; `interrupted` says whether somebody asked for an end, and
        is looked at while `put` waits. Raises RecorderError when shared memory has no room.
        """
        self.folder = folder
        self._clock = clock
        self._interrupted = interrupted
        self._ring = Ring.create(capacity, this_process()["started"], folder)
        self._process: subprocess.Popen[bytes] | None = None
        self._kept: int | None = None  # rows, once closed

    @property
    def ring(self) -> Path:
        """Where other processes can read the rows as they come: `Ring.attach(recorder.ring)`."""
        return self._ring.path

    def start(self) -> None:
        """Start the process and wait until its journal is open. Raises RecorderError (UsageError for a folder that is
        no run) with the reason why it is not.

        Call it before the loop pins or schedules itself: a child inherits the processors it may run on.
        """
        try:
            with manifest.told(RecorderError, f"samples cannot be kept in {self.folder}"):
                manifest.update(self.folder, ring=str(self._ring.path))
            self._spawn()
        except HdrigError:
            self._stop()
            self._discard()
            raise

    def put(self, sample: Sample, tau_ask: float, tau_applied: float, theta_ref: float) -> None:
        """Keep one row. On a virtual clock it waits for room, while there is hope; on a wall clock no room raises
        RecorderError.
        """
        while not self._ring.put(sample, tau_ask, tau_applied, theta_ref):
            self._await_room()

    def _await_room(self) -> None:
        began = time.monotonic()
        while self._ring.head - self._ring.acked >= self._ring.capacity:
            self.check()
            behind = f"the recorder is {self._ring.capacity} rows behind, as many as can wait"
            if not self._clock.relax():
                raise RecorderError(f"{behind}; the disk of {self.folder} is too slow or stuck")
            waited = time.monotonic() - began
            if waited > STUCK or (waited > STUCK_WHEN_ASKED and self._interrupted()):
                raise RecorderError(
                    f"{behind}, and has kept none for {waited:.0f} s; the disk of {self.folder} is stuck, or the "
                    "recorder's process was stopped"
                )

    def check(self) -> None:
        """Raises RecorderError when the recorder reported an error or its process died. About 1 µs."""
        if self._ring.error:
            raise RecorderError(f"{self._ring.error} ({self._ring.written} rows are in the journal)")
        if self._process is not None and self._process.poll() is not None:
            left = self._ring.head - self._ring.written
            fate = "are in memory and will be kept" if self._ring.path.exists() else f"are lost: {self._gone()}"
            raise RecorderError(
                f"the recorder died ({_cause(self._process.returncode)}) with {self._ring.written} rows in the "
                f"journal; {left} more {fate}"
            )

    def close(self) -> int:
        """Wait until every row is on disk; returns how many. Idempotent.

        A recorder that died or failed is started once more, from where the journal ends. If that fails too, the rows
        stay in the ring and RecorderError says where, or that somebody removed it.
        """
        if self._kept is None:
            self._ring.finish()
            missing = 0  # of what an earlier recorder wrote
            try:
                if not self._ended_well():
                    self._spawn()  # finds the ring closed: writes what the journal lacks, and ends
                    if not self._ended_well():
                        self.check()  # raises: it has ended, and not well
                    missing = rows_missing(self.folder)
            except RecorderError as error:
                raise RecorderError(f"{error}; {self._left_behind()}") from error
            put = self._ring.acked
            self._discard(put - missing)
            if missing:
                raise RecorderError(f"{missing} of {put} rows are lost: a journal was removed or cut")
        return self._kept or 0

    def _spawn(self) -> None:
        command = [sys.executable, "-m", "rig.recorder", str(self.folder), str(self._ring.path)]
        self._ring.tell_reader(0, 0)  # the error of the one before is told already
        # a group of its own: a Ctrl-C must not reach it even before it has learnt to ignore one
        with manifest.told(RecorderError, "the recorder's process cannot be started"):
            self._process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, process_group=0
            )
        give_up = time.monotonic() + READY_WITHIN
        while self._ring.reader[0] != self._process.pid and self._process.poll() != 0:
            self.check()
            if time.monotonic() > give_up:
                raise RecorderError(f"the recorder opened no journal in {self.folder} within {READY_WITHIN:.0f} s")
            time.sleep(0.002)

    def _stop(self) -> None:
        """End a process that never began to record."""
        if self._process is not None:
            self._process.kill()
            with contextlib.suppress(subprocess.TimeoutExpired):  # stuck in the disk's driver: not ours to wait for
                self._process.wait(1.0)

    def _ended_well(self) -> bool:
        """Wait for the process. True when it kept every row; False when it died or failed."""
        if self._process is None:
            return True
        try:
            code = self._process.wait(DONE_WITHIN)
        except subprocess.TimeoutExpired:
            raise RecorderError(f"the recorder has not ended {DONE_WITHIN:.0f} s after the last row") from None
        return code == 0 and self._ring.acked == self._ring.head

    def _left_behind(self) -> str:
        safe, put = self._ring.written, self._ring.head
        if not self._ring.path.exists():
            return f"{safe} of {put} rows are in the journal, the last {put - safe} are lost: {self._gone()}"
        return (
            f"{safe} of {put} rows are in the journal, the last {put - safe} in {self._ring.path}; "
            f"mend the cause, then: hdrig recover {self.folder}"
        )

    def _gone(self) -> str:
        return f"somebody removed {self._ring.path}, where they waited"

    def _discard(self, kept: int = 0) -> None:
        self._kept = kept
        self._ring.unlink()
        self._ring.close()


def _cause(code: int) -> str:
    """How a process ended, in words."""
    return f"killed by signal {-code}" if code < 0 else f"exit code {code}"
