"""What happens in a session, into the events of the run it happens in; what comes before a run opens the next one's."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from rig.runfile.events import EventLog
from rig.session.behind import Behind
from rig.session.observer import Observer
from rig.supervisor import KEEP_CLEAR, Act, State

KINDS = {Act.TRIP: "trip", Act.HOLD: "operator", Act.STOP: "operator", Act.HALT: "operator"}


class SessionLog:
    """Events of one session; `run_time` gives the time [s] since the run's start, `observer` is told as well."""

    def __init__(self, run_time: Callable[[], float], observer: Observer) -> None:
        self._run_time = run_time
        self._observer = observer
        self._early: list[tuple[str, str]] = []  # events before there is a folder for them
        self._log: Behind | None = None

    def open(self, folder: Path) -> None:
        """From here events go into `folder`, those that wait first. Raises RecorderError."""
        log = EventLog(folder)
        for kind, text in self._early:
            log.write(kind, text)
        self._early.clear()
        self._log = Behind(log)

    def announce(self, state: State, act: Act, why: str) -> None:
        """The supervisor's change of state, as an event."""
        text = f"{state}: {why}" if why else str(state)
        if act is Act.HALT:  # "ready" in front of a halt would be understood by nobody
            ready = "" if KEEP_CLEAR in why else f", the rig is {state} for another run"
            text = f"{why}; the drive confirms it{ready}"
        self.event(KINDS.get(act, "state"), text)

    def tripped(self, why: str) -> None:
        """To the observer alone, before the drive has confirmed that its torque is off; the event follows."""
        self._observer.tripped(why, self._t())

    def event(self, kind: str, text: str) -> None:
        """`kind` as in `events.jsonl`: state, trip, operator, note, finding. Never waits for the disk."""
        t = self._t()
        self._observer.event(kind, text, t)
        if self._log is None:
            self._early.append((kind, text))
        else:
            self._log.write(kind, text, t)

    def close(self) -> bool:
        """No folder takes events any more; whether those told are written, which they are unless the disk hangs.
        Idempotent. Raises RecorderError.
        """
        log, self._log = self._log, None
        return log is None or log.close()

    def _t(self) -> float | None:
        """s since the run's start; None outside of one."""
        return None if self._log is None else self._run_time()
