"""What happens while a verb works on a rig, as events: one JSON object each, the same for every way of showing them.

With `--json` each is a line on stdout, and nothing else is; of a dry run its lines are `said`, of what is refused at
once, a wrong command line too, there is `exit` alone. Every event has `event` and `utc` (ISO 8601); the others:

| event | further keys | when |
|---|---|---|
| bench | bench, simulated, clock, ratio, gear | first |
| simulated | text | connected: over the wire it is the twin that answers |
| said | text | a sentence for the person |
| prompt | text | somebody is asked for a change by hand, or whether to try again |
| state, operator, note, finding | text, t | as in `events.jsonl`; `t` s of run time, null outside of a run |
| trip | text, t | at once; again, whole, with what is found out later: that the drive did not confirm, what turns on |
| run | folder, procedure, title, duration_s, ring | a run is about to start |
| progress | t, state, lateness_p50_us, lateness_p99_us, missed, peak_to_peak_arcsec, rows, skipped | 2 a second |
| ended | folder, status, reason, exit | torque is off, the run is being closed |
| result | folder, simulated, report, result | a run was analysed; `result` is its result.json |
| figure | folder, text | the main figure of a run in a sentence |
| campaign | folder, status, runs | a campaign or a loop came to its end |
| exit | code, error | last; `error` a sentence, or null |

`lateness_*` are null on a virtual clock, which is never late; `peak_to_peak_arcsec` is that of θ_m/N − θ_l over the
last motor turn that was passed through one way, null before there was one. Keys may be added; none changes its meaning.
"""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, final

from rig.bench import Bench
from rig.commands.show.outlet import Outlet, outlet
from rig.commands.show.words import wired_twin
from rig.core.clock import NEVER
from rig.core.errors import Exit, HdrigError
from rig.core.sample import Sample
from rig.loop import Ending
from rig.runfile.manifest import utc_now
from rig.session.done import Watch
from rig.session.observer import Begun, Observer
from rig.supervisor import PRESS, State
from rig.timing.ticks import LoopTiming

NOW = (
    f"{PRESS[0].upper()}{PRESS[1:]}: a drive that hears nothing any more takes it off by itself only where its "
    "watchdog is set. When the rig is whole, free to turn, and the drive answers again: hdrig reset."
)
PERIOD = 0.1  # s of wall time between two pictures of a run
LATENESS = 0.5  # s between two looks at the statistics, which take longer


@final
class Show(Observer):
    """Makes events; whoever draws them is at the other end of the outlet."""

    def __init__(self, outlet: Outlet) -> None:
        self._outlet = outlet
        self.left = False
        self.energised = False  # between the start of a run and its end
        self._trip = ""  # what was told of one before the drive had confirmed anything

    def tell(self, kind: str, **keys: Any) -> None:
        """One event. Never waits and never raises."""
        self._outlet.put({"event": kind, "utc": utc_now(), **keys})

    def bench(self, bench: Bench, clock: str) -> None:
        """Which rig, and whether it is one."""
        name, gear = bench.file.name, bench.file.gear
        self.tell("bench", bench=name, simulated=bench.simulated or None, clock=clock, ratio=gear.N, gear=gear.serial)

    def say(self, text: str) -> None:
        """A sentence for the person."""
        self.tell("said", text=text)

    def prompt(self, text: str) -> None:
        """Somebody is asked for something."""
        self.tell("prompt", text=text)
        self._outlet.settle()  # it has to stand there before the answer is waited for

    def result(self, folder: Path, result: Mapping[str, Any], simulated: bool) -> None:
        """A run was analysed; `result` is its result.json."""
        report = str(folder / "report.html")
        self.tell("result", folder=str(folder), simulated=simulated, report=report, result=result)

    def leave(self, code: int, error: str | None = None) -> int:
        """The last word: the exit code, which is given back. Everything is drawn when this returns."""
        if not self.left:
            self.left = True
            self.tell("exit", code=int(code), error=error)
            self._outlet.close()
        return int(code)

    def simulated(self, bench: str) -> None:
        """From the session, once connected: over the wire it is the twin that answers."""
        self.tell("simulated", text=wired_twin(bench))

    def event(self, kind: str, text: str, t: float | None) -> None:
        """From the session. A trip that was told is told again only with what is to be added to it."""
        told, self._trip = self._trip, "" if kind == "trip" else self._trip
        if kind != "trip" or text != told:
            self.tell(kind, text=text, t=t)

    def tripped(self, why: str, t: float | None) -> None:
        """From the session: a drive that is gone confirms nothing, and that takes a second to be found out."""
        self._trip = f"{State.FAULT}: {why}"
        self.tell("trip", text=self._trip, t=t)

    def warned(self, text: str) -> None:
        """From the session."""
        self.say(text)

    def begun(self, run: Begun) -> Watch:
        """From the session: a run is about to start."""
        self.energised, self._trip = True, ""
        self.tell(
            "run",
            folder=str(run.folder),
            procedure=run.procedure.name,
            title=run.procedure.title(),
            duration_s=run.duration,
            ring=str(run.ring),
        )
        return Progress(self, run.timing).watch

    def ended(self, folder: Path, ending: Ending) -> None:
        """From the session: torque is off."""
        self.energised = False
        self.tell("ended", folder=str(folder), status=ending.status, reason=ending.reason, exit=int(ending.exit))
        if not ending.confirmed:
            self.say(NOW)


class Progress:
    """How far a run is, now and then."""

    def __init__(self, show: Show, timing: LoopTiming) -> None:
        self._show, self._timing = show, timing
        self._told = self._looked = NEVER
        self._late: Mapping[str, float | int | None] = {}

    def watch(self, sample: Sample) -> None:
        """Every 100 ticks, in the loop's thread: a line of some 150 bytes into a pipe, ten times a second."""
        now = time.monotonic()
        if now - self._told < PERIOD:
            return
        self._told = now
        if now - self._looked >= LATENESS:
            self._looked, self._late = now, lateness(self._timing)
        self._show.tell("progress", t=sample.t, **self._late)


def lateness(timing: LoopTiming) -> dict[str, float | int | None]:
    """Of the run so far."""
    if timing.virtual:
        return {"lateness_p50_us": None, "lateness_p99_us": None, "missed": timing.missed}
    return {
        "lateness_p50_us": round(timing.quantile(0.50) * 1e6),
        "lateness_p99_us": round(timing.quantile(0.99) * 1e6),
        "missed": timing.missed,
    }


@contextlib.contextmanager
def showing(json: bool) -> Iterator[Show]:
    """What is shown of one verb: JSON lines on stdout, or a screen or lines on stderr.

    Leave it by `Show.leave`. With `json` whatever else is printed meanwhile goes to stderr.
    """
    show = Show(outlet(json))
    aside = contextlib.redirect_stdout(sys.stderr) if json else contextlib.nullcontext()
    try:
        with aside:
            yield show
    except HdrigError as error:
        show.leave(error.exit, str(error))
        error.told = True
        raise
    except KeyboardInterrupt:
        show.leave(Exit.HALTED, "interrupted")
        raise
    finally:
        show.leave(Exit.INTERNAL, "internal error")  # unless it was left already
