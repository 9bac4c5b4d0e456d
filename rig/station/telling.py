"""What goes out of the station: pictures of its status, events, idle samples, the run's ring. Never waits.

Within a tick nothing is sent but the rare event: waking another process can cost the loop milliseconds where that one's
processor is taken away, as in a virtual machine. The page reads the rows from the ring, and the counts from memory.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any, final

from rig.core.procedure import Procedure
from rig.core.sample import Sample
from rig.live.switches import Counted, Switches
from rig.loop import Ending
from rig.runfile import manifest
from rig.runfile.manifest import utc_now
from rig.session import Watch
from rig.session.observer import Begun, Observer
from rig.station.channel import Channel
from rig.station.status import Status
from rig.supervisor import State, Supervisor

OFTEN = 0.09  # s of wall time between two looks at the line at least: ten a second at 1 kHz and above
RARELY = 1.0  # s between two looks at the lateness, which costs 10 to 50 µs


@final
class Teller(Observer):
    """The session's observer. `attend` is called now and then while a run goes on: reads what pages ask meanwhile."""

    def __init__(self, channel: Channel, switches: Switches, status: Status, attend: Callable[[], None]) -> None:
        self.channel, self.switches, self.status, self.attend = channel, switches, status, attend
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

    def tripped(self, why: str, t: float | None) -> None:
        """A drive that is gone confirms nothing, and finding that out takes its time: the page is told before."""
        self.status.state = str(State.FAULT)
        self.status.fault = f"{why}; torque off is commanded, the drive has not yet confirmed it"
        self.channel.post({"kind": "status", "status": self.status.picture()})

    def begun(self, run: Begun) -> Watch:
        """The page is told where the rows are."""
        procedure = run.procedure
        self.status.run = {
            "uid": manifest.as_written(run.folder)["uid"], "procedure": procedure.name, "title": procedure.title(),
            "duration": run.duration, "locked": procedure.output_locked, "parameters": _parameters(procedure),
            "folder": str(run.folder), "ring": str(run.ring),
        }  # fmt: skip
        self.tell()

        self.switches.tell_counted(Counted())
        p50 = p99 = 0

        def watch(sample: Sample) -> None:
            """Called with every hundredth sample of the run; looks at the line every OFTEN s of wall time at most."""
            nonlocal p50, p99
            now, timing = time.monotonic(), run.timing
            if now - self._told < OFTEN:
                return
            self._told = now
            if now - self._measured >= RARELY:
                self._measured = now
                p50, p99 = round(timing.quantile(0.5) * 1e6), round(timing.quantile(0.99) * 1e6)
            self.switches.tell_counted(Counted(timing.ticks, timing.missed, p50, p99))
            self.attend()

        return watch

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
