"""A campaign of the twin as long as asked: what tracing needs, every run twice."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import pyarrow.parquet as pq

from rig.bench import read as read_bench
from rig.campaign.journal import new_journal
from rig.campaign.plan import parse_plan
from rig.campaign.planner import planned
from rig.campaign.run import Desk, conduct, open_session
from rig.campaign.steps import Item
from rig.process.interrupts import Interrupts
from rig.session.done import Watch, nobody
from tests.bench.built import Unavailable

SETTINGS: Final = ("loop.rate=556", "limits.travel_turns=10000")  # Hz: 45 minutes are then 1.5 million rows
SEED: Final = 1  # of the order
SPEEDS: Final = (60, -60, 120, 200, -200, 300, 400, -400, 500)  # rpm
WEIGHTS: Final = (-5.0, -10.0, -15.0, 10.0)  # N·m
LOCKS: Final = ((6.0, 0.75), (20.0, 2.5))  # N·m, and N·m/s
SECONDS: Final = 27.0  # at each speed, of a campaign of length 1


def plan(length: float) -> str:
    """Text of a plan; `length` 1 is about 45 minutes of runs."""
    cycles = max(1, round(4 * length))
    turns = {rpm: round(abs(rpm) / 60 * SECONDS * length) for rpm in (310, *SPEEDS)}
    steps = [
        _step("standstill", duration=30 * length),
        _step("kinematic-error", amplitude_deg=720, frequency=0.02, cycles=cycles),
        *(_step("constant-torque", speed_rpm=rpm, revolutions=turns[rpm]) for rpm in SPEEDS),
        *(_step("kinematic-error", w, amplitude_deg=360, frequency=0.04, cycles=cycles) for w in WEIGHTS),
        *(_step("stiffness-lock", tau_max=top, rate=rate, cycles=cycles, rates=[1.0]) for top, rate in LOCKS),
    ]
    head = 'schema = "hdrig.plan/1"\nname = "bench"\norder = "random"\non_failure = "stop"'
    return "\n".join([head, f"[sentinel]\nwith = {{ speed_rpm = 310, revolutions = {turns[310]} }}", *steps])


def _step(procedure: str, weight: float = 0.0, **parameters: object) -> str:
    told = ", ".join(f"{name} = {value}" for name, value in parameters.items())
    return f'[[step]]\nprocedure = "{procedure}"\nwith = {{ {told} }}\nweight = {weight}\nrepeats = 2'


def made(root: Path, length: float) -> Path:
    """The folder of such a campaign, made in `root` on the virtual clock; its runs are not analysed one by one."""
    bench = read_bench("twin", list(SETTINGS))
    campaign = planned(parse_plan(plan(length), f"length {length:g}"), bench, SEED)
    journal = new_journal(root / f"{length:g}", campaign, "virtual", list(SETTINGS))
    with (
        contextlib.redirect_stderr(io.StringIO()),
        open_session(campaign, journal, "virtual", Interrupts()) as session,
    ):
        done = conduct(session, campaign, journal, Nobody())
    if done:
        raise Unavailable(f"the campaign of length {length:g} ended with {done.name}, expected PASS")
    return journal.folder


class Nobody(Desk):
    """Nothing is told and no run is analysed."""

    def say(self, text: str) -> None:
        pass

    @contextlib.contextmanager
    def watching(self, item: Item, duration: float) -> Iterator[Watch]:
        yield nobody

    def figure(self, folder: Path) -> str:
        return ""


def size(folder: Path) -> tuple[int, float]:
    """Rows of a campaign, all that its runs have, and minutes from first to last row of each, together."""
    files = [pq.ParquetFile(path) for path in sorted(folder.glob("*/samples.parquet"))]
    times = [file.read(columns=["t"]).column("t") for file in files]
    minutes = sum(t[-1].as_py() - t[0].as_py() for t in times) / 60
    return sum(file.metadata.num_rows for file in files), minutes
