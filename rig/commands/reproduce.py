"""hdrig reproduce [CAMPAIGN]: the paper's figures and tables from a campaign, its claims ruled by the data."""

from __future__ import annotations

import argparse
import shlex
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from rig.bench import Bench, ClockName
from rig.bench import read as read_bench
from rig.campaign import summary
from rig.campaign.journal import NAME as JOURNAL
from rig.campaign.journal import new_journal
from rig.campaign.leaving import swept
from rig.campaign.plan import read_plan
from rig.campaign.planner import planned
from rig.campaign.run import conduct, open_session
from rig.commands.campaign import Terminal, refuse_nobody
from rig.commands.options import bench_arguments
from rig.commands.show.at_the_rig import at_the_rig
from rig.commands.show.show import Show, showing
from rig.commands.targets import refuse_unwritable
from rig.core.errors import DataError, Exit, HdrigError, UsageError
from rig.runfile.manifest import told
from rig.runfile.writing import writing

if TYPE_CHECKING:
    from concurrent.futures import Future

    from rig.analysis.reproduction.gather import Ahead, Entry
    from rig.analysis.reproduction.reading import Reading
    from rig.commands.person import Person

BENCH, PLAN = "twin-paper", "paper-short"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig reproduce`."""
    what = "folder of a campaign that was made: --out is then where the page goes, default that folder; without it "
    parser.add_argument("campaign", nargs="?", type=Path, metavar="CAMPAIGN", help=f"{what}the plan is made first")
    bench_arguments(parser)
    parser.add_argument("--plan", default=PLAN, metavar="PLAN", help=f"what to make without CAMPAIGN, default {PLAN}")
    parser.set_defaults(bench=BENCH, out=None)


def run(args: argparse.Namespace) -> int:
    """Make the campaign where none is given, then the page."""
    if args.campaign is not None:
        return draw(args.campaign, args.out or args.campaign)
    from rig.analysis.reproduction.gather import Ahead

    with Ahead() as ahead:
        folder, exit = make(args, ahead)
        if exit is Exit.PASS:
            return draw(folder, folder, ahead.begun)
    where = shlex.quote(str(folder))
    print(f"hdrig campaign --resume {where} goes on with it; hdrig reproduce {where} draws it", file=sys.stderr)
    return int(exit)


def make(args: argparse.Namespace, ahead: Ahead) -> tuple[Path, Exit]:
    """The plan, run by run, without a report for each; its folder and how it ended. Raises HdrigError."""
    seed = [] if args.seed is None else [f"twin.seed={args.seed}"]
    overrides = [*args.set, *seed]
    bench = read_bench(args.bench, overrides)
    campaign = planned(read_plan(args.plan), bench, args.seed or 0)
    refuse_nobody(campaign, range(len(campaign.items)))
    refuse_unwritable(args.out or Path("runs"))
    clock: ClockName = args.clock or ("virtual" if bench.simulated else "wall")
    journal = new_journal(args.out or Path("runs"), campaign, clock, overrides)
    desk = ReadAhead if clock == "virtual" else Recording
    with showing(json=False) as show:
        show.bench(bench, clock)
        with (
            swept(journal),
            at_the_rig(show) as (interrupts, person),
            open_session(campaign, journal, clock, interrupts, args.note, person, show) as session,
        ):
            show.say(f"campaign folder {journal.folder}")
            exit = conduct(session, campaign, journal, desk(bench, person, show, ahead))
        show.leave(exit)
    text = "\n".join(summary.lines(journal)) + "\n"
    with told(DataError, f"the runs are kept in {journal.folder}, its summary cannot be written"):
        (journal.folder / "summary.txt").write_text(text, encoding="utf-8")
    return journal.folder, exit


class Recording(Terminal):
    """Runs are recorded; what they say is read once, from all of them, for the page."""

    def __init__(self, bench: Bench, person: Person, show: Show, ahead: Ahead) -> None:
        super().__init__(bench, person, show)
        self.ahead = ahead

    def figure(self, folder: Path) -> str:
        return "recorded"


class ReadAhead(Recording):
    """They are read beside the next one: in virtual time nothing is late when the processors are busy."""

    def figure(self, folder: Path) -> str:
        self.ahead.begin(folder)
        return super().figure(folder)


def draw(campaign: Path, out: Path, begun: Mapping[Path, Future[Reading]] = MappingProxyType({})) -> int:
    """The page from the runs in `campaign` into `out`; `begun` are being read. Raises UsageError and DataError."""
    from rig.analysis.reproduction.catalogue import exhibits
    from rig.analysis.reproduction.gather import entries, gather
    from rig.report.reproduction import About, write
    from rig.report.reproduction import told as told_of

    if not campaign.is_dir():
        raise UsageError(f"{campaign} is no folder; expected that of a campaign")
    refuse_unwritable(out)
    no_runs: list[str] = []
    found = entries(campaign, no_runs.append)
    read = gather(found, lambda text: print(f"reproduce: {text}", file=sys.stderr), begun=begun)
    left_out = (*no_runs, *read.left_out)
    made = exhibits(read)
    backends = {str(e.manifest.get("backend")) for e in found}
    backend = "sim" if "sim" in backends else next(iter(backends)) if len(backends) == 1 else None
    with writing(out):
        out.mkdir(parents=True, exist_ok=True)
        page = write(out, made, About(facts(campaign, found), left_out, backend))
    print("SIMULATED" if backend == "sim" else f"campaign {campaign.name}")
    print("\n".join([*told_of(made), *(f"left out: {why}" for why in left_out)]))
    print(f"page {page}")
    return int(Exit.INCOMPLETE if any(e.missing for e in made) else Exit.PASS)


def facts(campaign: Path, found: Sequence[Entry]) -> list[str]:
    """What stands below the title."""
    gear = found[0].manifest.get("gear") or {}
    days = sorted({str(e.manifest.get("started_utc") or "")[:10] for e in found} - {""})
    said = [f"Gear {gear['serial']}"] if gear.get("serial") else []
    said += [f"ratio {gear['ratio']:g}"] if isinstance(gear.get("ratio"), int | float) else []
    said.append(f"{len(found)} runs")
    said += [days[0] if len(days) == 1 else f"{days[0]} to {days[-1]}"] if days else []
    return [*said, *_planned(campaign), campaign.resolve().name]


def _planned(campaign: Path) -> list[str]:
    """Plan and bench, where the folder says them."""
    from rig.campaign.journal import read_journal

    if not (campaign / JOURNAL).is_file():
        return []
    try:
        book = read_journal(campaign).book
    except HdrigError:
        return []
    return [f"plan {Path(str(book['plan']['source'])).stem}", f"bench {Path(str(book['bench']['source'])).stem}"]
