"""hdrig campaign PLAN: many runs by one plan, in order, resumable; --dry-run tells what it would do."""

from __future__ import annotations

import argparse
import contextlib
import secrets
import sys
from collections.abc import Iterator
from pathlib import Path

from rig.bench import Bench
from rig.bench import read as read_bench
from rig.campaign import dry_run, summary
from rig.campaign.journal import Journal, new_journal, read_journal, refuse_other_campaign
from rig.campaign.plan import PLANS, Plan, read_plan
from rig.campaign.planner import Campaign, planned
from rig.campaign.resume import take_up
from rig.campaign.run import Desk, conduct
from rig.campaign.steps import Item
from rig.commands.options import bench_arguments
from rig.commands.person import Person
from rig.commands.progress import Progress
from rig.core.errors import UsageError
from rig.interrupts import Interrupts
from rig.session import Session, Watch, operator

SEEDS = 2**31  # of the order, drawn when none is given


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig campaign`."""
    ships = ", ".join(sorted(p.stem for p in PLANS.glob("*.toml")))
    parser.add_argument("plan", nargs="?", metavar="PLAN", help=f"plan file, or the name of one that ships: {ships}")
    bench_arguments(parser)
    parser.set_defaults(bench=None)
    parser.add_argument("--resume", type=Path, metavar="FOLDER", help="go on with the campaign in this folder")
    parser.add_argument(
        "--skip", type=_numbers, default=[], metavar="N,…", help="with --resume: runs, by number, that are not made"
    )
    parser.add_argument("--dry-run", action="store_true", help="print what it would do and the margins; write nothing")


def run(args: argparse.Namespace) -> int:
    """Plan, then dry run, or everything that is still to be made."""
    if args.skip and not args.resume:
        raise UsageError("--skip goes with --resume: leave the step out of the plan instead")
    journal = read_journal(args.resume) if args.resume else None
    overrides = _overrides(args, journal)
    campaign = _campaign(args, journal, overrides)
    if args.dry_run:
        print("\n".join(dry_run.lines(campaign)))
        return 0
    clock = args.clock or (journal.book["clock"] if journal else "virtual" if campaign.bench.simulated else "wall")
    if journal is None:
        journal = new_journal(args.out, campaign, clock, overrides)
    else:
        _resume(journal, campaign, args.skip)
    return make(campaign, journal, clock, args.note)


def make(campaign: Campaign, journal: Journal, clock: str, note: str) -> int:
    """Every run that is open, then the summary on stdout; the exit code."""
    if campaign.bench.simulated:
        print(f"SIMULATED: bench '{campaign.bench.file.name}' is the twin, {clock} clock", file=sys.stderr)
    print(f"campaign folder {journal.folder}", file=sys.stderr)
    with Interrupts() as interrupts:
        desk, hand = Terminal(campaign.bench), None if campaign.bench.simulated else Person(interrupts)
        with Session(campaign.bench, clock, journal.folder, interrupts, note, hand) as session:  # type: ignore[arg-type]
            exit = conduct(session, campaign, journal, desk)
    text = "\n".join(summary.lines(journal)) + "\n"
    (journal.folder / "summary.txt").write_text(text, encoding="utf-8")
    print(f"{text}campaign folder {journal.folder}")
    if exit:
        print(f"hdrig campaign --resume {journal.folder} goes on with it", file=sys.stderr)
    return int(exit)


class Terminal(Desk):
    """Lines and a bar on stderr."""

    def __init__(self, bench: Bench) -> None:
        self.bench = bench

    def say(self, text: str) -> None:
        print(text, file=sys.stderr)

    @contextlib.contextmanager
    def watching(self, item: Item, duration: float) -> Iterator[Watch]:
        with Progress(item.title, duration, self.bench.file.gear.N) as progress:
            yield progress.watch

    def figure(self, folder: Path) -> str:
        from rig.commands.analyse import analyse_folder

        return analyse_folder(folder, folder)[0].sentence


def _campaign(args: argparse.Namespace, journal: Journal | None, overrides: list[str]) -> Campaign:
    """What is asked for; with --resume the plan, bench and seed it began with unless named otherwise."""
    source = args.plan or (journal.book["plan"]["source"] if journal else None)
    if source is None:
        raise UsageError("name a plan, or a campaign to go on with by --resume FOLDER")
    plan: Plan = read_plan(source)
    bench = read_bench(args.bench or (journal.book["bench"]["source"] if journal else "twin"), overrides)
    if journal is None:
        return planned(plan, bench, secrets.randbelow(SEEDS) if args.seed is None else args.seed)
    seed = journal.book["seed"] if args.seed is None else args.seed
    campaign = planned(plan, bench, seed)
    refuse_other_campaign(journal, campaign)
    return campaign


def _overrides(args: argparse.Namespace, journal: Journal | None) -> list[str]:
    """--set and --seed; with --resume and neither, those it began with."""
    if journal is not None and not args.set and args.seed is None:
        return list(journal.book["bench"]["overrides"])
    twin = args.bench is None or read_bench(args.bench).simulated
    return [*args.set, *([f"twin.seed={args.seed}"] if args.seed is not None and twin else [])]


def _resume(journal: Journal, campaign: Campaign, skip: list[int]) -> None:
    for told in take_up(journal):
        print(told, file=sys.stderr)
    for number in skip:
        if not 0 < number <= len(campaign.items):
            raise UsageError(f"--skip {number}: the campaign has runs 1 to {len(campaign.items)}")
        if number - 1 in journal.open_runs():
            journal.skip(number - 1, operator() or "the operator")


def _numbers(text: str) -> list[int]:
    return [int(part) for part in text.split(",")]
