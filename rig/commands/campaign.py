"""hdrig campaign PLAN: many runs by one plan, in order, resumable; --dry-run tells what it would do."""

from __future__ import annotations

import argparse
import contextlib
import shlex
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from rig.bench import Bench, ClockName
from rig.bench import read as read_bench
from rig.campaign import dry_run, summary
from rig.campaign.changes import ByHand, deeds
from rig.campaign.figures import write_missing_figures
from rig.campaign.journal import NAME as JOURNAL
from rig.campaign.journal import Journal, new_journal, read_journal, refuse_other_campaign
from rig.campaign.leaving import swept
from rig.campaign.lost import lost_runs, still_to_make
from rig.campaign.plan import PLANS, Plan, read_plan
from rig.campaign.planner import Campaign, any_seed, planned
from rig.campaign.resume import take_up
from rig.campaign.run import Desk, close_settled, conduct, nothing_left, open_session
from rig.campaign.steps import Item
from rig.commands import identify
from rig.commands.options import bench_arguments, show_argument
from rig.commands.perform import let_be
from rig.commands.person import Person
from rig.commands.show.at_the_rig import at_the_rig
from rig.commands.show.beforehand import foretell, refusing
from rig.commands.show.onlookers import Onlookers
from rig.commands.show.show import Show, showing
from rig.commands.targets import refuse_unwritable
from rig.commands.viewing import view, view_argument
from rig.core.errors import DataError, Exit, NotReady, UsageError
from rig.core.operator import Rigging
from rig.evaluation.traceback_file import broke_off
from rig.process.software import operator
from rig.runfile.manifest import told
from rig.session.done import Watch, nobody

DEFAULT = "twin"
STUMBLES = (OSError, MemoryError, ArithmeticError, AssertionError, AttributeError, ImportError, LookupError, NameError,
            RecursionError, TypeError, ValueError)  # fmt: skip
"""What the report of a run can break off with, an analysis that does telling it by itself; the campaign goes on."""
HINTS = {
    "--limit": "a limit judges runs once they are made, and only those of one kind: "
    "hdrig analyse CAMPAIGN/*kinematic-error* --limit 'peak-to-peak=60 arcsec'"
}
"""What is said of options that are looked for here and are elsewhere."""


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig campaign`."""
    ships = ", ".join(sorted(p.stem for p in PLANS.glob("*.toml")))
    parser.add_argument("plan", nargs="?", metavar="PLAN", help=f"plan file, or the name of one that ships: {ships}")
    bench_arguments(parser)
    parser.set_defaults(bench=None, before=let_be)
    show_argument(parser)
    view_argument(parser)
    parser.add_argument("--resume", type=Path, metavar="FOLDER", help="go on with the campaign in this folder")
    parser.add_argument(
        "--skip", type=_numbers, default=[], metavar="N,…", help="with --resume: runs, by number, that are not made"
    )
    parser.add_argument("--dry-run", action="store_true", help="print what it would do and the margins; write nothing")


def run(args: argparse.Namespace) -> int:
    """Plan, then dry run, or everything that is still to be made."""
    with refusing(args.json):
        return _run(args)


def _run(args: argparse.Namespace) -> int:
    if args.resume:
        return _resume(args)
    if args.skip:
        raise UsageError("--skip goes with --resume: leave the step out of the plan instead")
    if args.plan is None:
        raise UsageError("name a plan, or a campaign to go on with by --resume FOLDER")
    _refuse_campaign(args.plan)
    return begin(read_plan(args.plan), args)


def _refuse_campaign(named: str) -> None:
    """Raises UsageError where the folder of a campaign was named in place of a plan."""
    if (Path(named) / JOURNAL).is_file():
        resumed = f"hdrig campaign --resume {shlex.quote(named)}"
        raise UsageError(f"{named} is the folder of a campaign, expected a plan; {resumed} goes on with it")


def begin(plan: Plan, args: argparse.Namespace) -> int:
    """A new campaign, or what it would do; `args` are those of `bench_arguments`, and dry_run."""
    overrides = overrides_of(args)
    bench = read_bench(args.bench or DEFAULT, overrides)
    campaign = planned(plan, bench, any_seed() if args.seed is None else args.seed)
    if args.dry_run:
        return foretell(args.json, dry_run.lines(campaign))
    refuse_nobody(campaign, range(len(campaign.items)))
    refuse_unwritable(args.out)
    clock: ClockName = args.clock or ("virtual" if bench.simulated else "wall")
    with showing(args.json) as show:
        return make(campaign, new_journal(args.out, campaign, clock, overrides), clock, args, show)


def _resume(args: argparse.Namespace) -> int:
    """Go on with plan, bench, seed and clock it began with; what is named again has to be the same."""
    journal = read_journal(args.resume)
    book = journal.book
    plan = read_plan(args.plan or _plan_of(journal))
    overrides = overrides_of(args) if args.set or args.seed is not None else list(book["bench"]["overrides"])
    bench = read_bench(args.bench or book["bench"]["source"], overrides)
    campaign = planned(plan, bench, book["seed"] if args.seed is None else args.seed)
    refuse_other_campaign(journal, campaign)
    lost = lost_runs(journal)
    todo = still_to_make(journal, lost)
    if args.dry_run:
        return foretell(args.json, [*lost.values(), *dry_run.lines(campaign, todo)])
    refuse_nobody(campaign, todo)
    for line in take_up(journal):
        print(line, file=sys.stderr)
    for number in args.skip:
        if not 0 < number <= len(campaign.items):
            raise UsageError(f"--skip {number}: the campaign has runs 1 to {len(campaign.items)}")
        if number - 1 in journal.open_runs():
            journal.skip(number - 1, operator() or "the operator")
    with showing(args.json) as show:
        if nothing_left(journal):
            write_missing_figures(journal, figure, show.say)
            show.say("every run of this campaign is settled: nothing is moved")
            return _told(journal, close_settled(journal), show)
        return make(campaign, journal, args.clock or book["clock"], args, show)


def make(campaign: Campaign, journal: Journal, clock: ClockName, args: argparse.Namespace, show: Show) -> int:
    """Every run that is open, then the summary on stdout; the exit code."""
    show.bench(campaign.bench, clock)
    with (
        swept(journal),
        view(args.view) as looking_on,
        at_the_rig(show) as (interrupts, person),
        open_session(campaign, journal, clock, interrupts, args.note, person, Onlookers(show, looking_on)) as session,
    ):
        show.say(f"campaign folder {journal.folder}")
        args.before(session, show)
        exit = conduct(session, campaign, journal, Terminal(campaign.bench, person, show))
    return _told(journal, exit, show)


def _told(journal: Journal, exit: Exit, show: Show) -> int:
    """The summary on stdout and in the folder, and what follows the last run; the exit code."""
    text = "\n".join(summary.lines(journal)) + "\n"
    try:
        with told(DataError, f"the runs are kept in {journal.folder}, its summary cannot be written"):
            (journal.folder / "summary.txt").write_text(text, encoding="utf-8")
    except DataError as error:
        if not exit:
            raise
        print(f"hdrig: {error}", file=sys.stderr)  # what ended the campaign says how this ends
    show.tell("campaign", folder=str(journal.folder), status=journal.book["status"], runs=journal.count())
    show.leave(exit)
    print(f"{text}campaign folder {journal.folder}")
    if exit and not nothing_left(journal):
        print(f"hdrig campaign --resume {shlex.quote(str(journal.folder))} goes on with it", file=sys.stderr)
    if exit:
        return int(exit)
    return followed(journal.folder)


def followed(folder: Path) -> int:
    """What follows the campaign in `folder`, on stdout; the exit code."""
    from rig.evaluation.afterwards import afterwards

    made = afterwards(folder, identify.say)
    for line in made.lines:
        print(line)
    if made.result is not None and made.result.defect:
        print(f"hdrig: {folder}: {made.result.sentence}", file=sys.stderr)
    return int(made.exit)


def refuse_nobody(campaign: Campaign, runs: Sequence[int]) -> None:
    """Raises NotReady when there is something to be changed by hand and nobody to be asked, before anything moves."""
    todo = deeds([(k, campaign.items[k]) for k in runs], Rigging())
    first = next((deed.change for deed in todo if isinstance(deed, ByHand)), None)
    if first is not None and campaign.bench.by_person and not sys.stdin.isatty():
        raise NotReady(f"the campaign needs somebody to {first.words()}: standard input is no terminal")


class Terminal(Desk):
    """What is said and asked at the terminal; the session's observer shows the runs."""

    def __init__(self, bench: Bench, person: Person, show: Show) -> None:
        self.bench, self.person, self.show = bench, person, show

    def say(self, text: str) -> None:
        self.show.say(text)

    @contextlib.contextmanager
    def watching(self, item: Item, duration: float) -> Iterator[Watch]:
        yield nobody

    def again(self, why: str) -> bool:
        return self.bench.by_person and self.person.again(why)

    def figure(self, folder: Path) -> str:
        return figure(folder)


def figure(folder: Path) -> str:
    """The run is whole and can be analysed again: nothing its analysis stumbles over may end the campaign."""
    try:
        from rig.evaluation.run import analyse_folder

        return analyse_folder(folder, folder)[0].sentence
    except STUMBLES as error:
        raise DataError(broke_off(folder, error)) from error


def _plan_of(journal: Journal) -> str:
    """Where the plan came from; a sweep asked for by name, or a plan that is no longer there, from the campaign."""
    source = str(journal.book["plan"]["source"])
    ships = source in {path.stem for path in PLANS.glob("*.toml")}
    return source if ships or Path(source).is_file() else str(journal.folder / "plan.toml")


def overrides_of(args: argparse.Namespace) -> list[str]:
    """--set, and --seed where there is a twin to take it."""
    twin = args.seed is not None and read_bench(args.bench or DEFAULT).simulated
    return [*args.set, *([f"twin.seed={args.seed}"] if twin else [])]


def _numbers(text: str) -> list[int]:
    """Whole numbers, as a person lists them."""
    try:
        return [int(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: expected whole numbers, for example 3,7") from None
