"""What goes out of the station: pictures of its status, events, idle samples, the run's ring. Never waits."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any, final

from rig.core.procedure import Procedure
from rig.core.sample import Sample
from rig.loop import Ending
from rig.runfile import manifest
from rig.runfile.manifest import utc_now
from rig.session import Watch
from rig.session.observer import Begun, Observer
from rig.station.channel import Channel
from rig.station.status import Status
from rig.supervisor import Supervisor

OFTEN = 0.09  # s of wall time between two words of progress: ten a second
RARELY = 1.0  # s between two looks at the lateness, which costs 10 to 50 µs


@final
class Teller(Observer):
    """The session's observer. `attend` is called now and then while a run goes on: reads what pages ask meanwhile."""

    def __init__(self, channel: Channel, status: Status, attend: Callable[[], None]) -> None:
        self.channel, self.status, self.attend = channel, status, attend
        self.supervisor: Supervisor | None = None
        self._told = time.monotonic()
        self._measured = 0.0

    def tell(self) -> None:
        """The whole picture, in order with everything else that must arrive."""
        if self.supervisor is not None:
            self.status.state, self.status.fault = str(self.supervisor.state), self.supervisor.fault
        self.channel.post({"kind": "status", "status": self.status.picture()})

    def say(self, kind: str, text: str, t: float | None = None) -> None:
        """An event for the page, kinds as in `events.jsonl`, and "refused"."""
        self.channel.post({"kind": "event", "event": {"t": t, "utc": utc_now(), "kind": kind, "text": text}})

    def event(self, kind: str, text: str, t: float | None) -> None:
        """The session's own, and what has changed with it."""
        self.say(kind, text, t)
        if kind in ("state", "trip", "operator"):
            self.tell()

    def begun(self, run: Begun) -> Watch:
        """The page is told where the rows are."""
        procedure = run.procedure
        self.status.run = {
            "uid": manifest.read(run.folder)["uid"], "procedure": procedure.name, "title": procedure.title(),
            "duration": run.duration, "locked": procedure.output_locked, "parameters": _parameters(procedure),
            "folder": str(run.folder), "ring": str(run.ring), "rows": 0, "t": 0.0,
            "lateness": {"p50_us": None, "p99_us": None, "missed": 0},
        }  # fmt: skip
        self.tell()

        def watch(sample: Sample) -> None:
            now = time.monotonic()
            if now - self._told >= OFTEN:
                self._told = now
                self._progress(sample, run, now)
                self.attend()

        return watch

    def _progress(self, sample: Sample, run: Begun, now: float) -> None:
        """Called within a tick: some tens of µs, and nothing that could wait."""
        timing, status = run.timing, self.status.run
        if status is None:
            return
        status["t"], status["rows"] = sample.t, timing.ticks
        status["lateness"]["missed"] = timing.missed
        if now - self._measured >= RARELY:
            self._measured = now
            status["lateness"] |= {"p50_us": timing.quantile(0.5) * 1e6, "p99_us": timing.quantile(0.99) * 1e6}
        self.channel.offer(
            {
                "kind": "progress",
                "uid": status["uid"],
                "t": sample.t,
                "rows": timing.ticks,
                "lateness": status["lateness"],
            }
        )

    def ended(self, folder: Path, ending: Ending) -> None:
        """What became of it, before its folder is closed."""
        run, self.status.run = self.status.run, None
        self.status.last_run = {
            "uid": run["uid"] if run else "", "title": run["title"] if run else "", "status": ending.status,
            "reason": ending.reason, "folder": str(folder), "report": None, "verdict": None, "sentence": None,
        }  # fmt: skip
        self.tell()

    def idle(self, sample: Sample, t: float) -> None:
        """A reading while nothing runs, `t` s on the clock of the instruments."""
        # NaN is no JSON: what is not measured is null
        values = [x if x == x else None for x in (*sample[1:7],)]
        self.channel.offer({"kind": "idle", "t": t, "row": values, "flags": sample.flags, "fault": sample.fault})


def _parameters(procedure: Procedure) -> dict[str, Any]:
    """As the page shows them; what is no number was not given."""
    found = {f.name: getattr(procedure, f.name) for f in fields(procedure)}  # type: ignore[arg-type]
    return {name: value for name, value in found.items() if not isinstance(value, float) or math.isfinite(value)}
