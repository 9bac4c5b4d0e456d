"""hdrig close-loop: campaign, trace, the run the trace asks for, trace again, until nothing is missing."""

from __future__ import annotations

import argparse
import shlex
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from rig.bench import ClockName
from rig.bench import read as read_bench
from rig.campaign.changes import deeds
from rig.campaign.dry_run import lasting
from rig.campaign.journal import Journal, new_journal, read_journal
from rig.campaign.leaving import swept
from rig.campaign.lost import lost_runs
from rig.campaign.plan import PLANS, read_plan
from rig.campaign.planner import Campaign, any_seed, planned
from rig.campaign.resume import take_up
from rig.campaign.run import nothing_left, open_session
from rig.commands.campaign import DEFAULT, Terminal, overrides_of, refuse_nobody
from rig.commands.options import bench_arguments, show_argument
from rig.commands.show.at_the_rig import at_the_rig
from rig.commands.show.beforehand import refusing
from rig.commands.show.show import Show, showing
from rig.commands.targets import refuse_unwritable
from rig.core.errors import Exit, UsageError
from rig.core.operator import Rigging
from rig.evaluation.trace import trace_folder

if TYPE_CHECKING:
    from rig.closing.story import Story

PLAN = "modest"
BUDGET = 60.0  # min of rig time: the default plan takes 8, one run that decides 1 to 5


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig close-loop`."""
    ships = ", ".join(sorted(p.stem for p in PLANS.glob("*.toml")))
    parser.add_argument("--plan", default=PLAN, metavar="PLAN", help=f"what to begin with ({PLAN}); ships: {ships}")
    bench_arguments(parser)
    parser.set_defaults(bench=None)
    show_argument(parser)
    parser.add_argument(
        "--budget-minutes",
        type=float,
        metavar="M",
        help=f"of rig time, at most ({BUDGET:g}; a resumed loop keeps its own)",
    )
    parser.add_argument("--resume", type=Path, metavar="FOLDER", help="go on with the loop in this folder")


def run(args: argparse.Namespace) -> int:
    """Begin or go on, round after round; then the story as JSON and as a page."""
    with refusing(args.json):
        if args.budget_minutes is not None and not args.budget_minutes > 0:
            raise UsageError(f"--budget-minutes {args.budget_minutes:g}: expected minutes of rig time above 0")
        return _resume(args) if args.resume else _begin(args)


def _begin(args: argparse.Namespace) -> int:
    from rig.closing.story import Story, write_story

    overrides = overrides_of(args)
    bench = read_bench(args.bench or DEFAULT, overrides)
    seed = any_seed() if args.seed is None else args.seed
    campaign = planned(read_plan(args.plan), bench, seed)
    refuse_nobody(campaign, range(len(campaign.items)))
    budget = BUDGET if args.budget_minutes is None else args.budget_minutes
    _refuse_beyond(campaign, range(len(campaign.items)), budget, 0.0)
    refuse_unwritable(args.out)
    clock: ClockName = args.clock or ("virtual" if bench.simulated else "wall")
    journal = new_journal(args.out, campaign, clock, overrides)
    story = Story(journal.folder.name, bench.simulated, budget)
    write_story(journal.folder, story)
    with showing(args.json) as show:
        return _make(campaign, journal, clock, args.note, story, show)


def _resume(args: argparse.Namespace) -> int:
    """Plan, bench, seed and clock are those it began with, and the budget where none is asked for."""
    from rig.closing.grow import regrown
    from rig.closing.story import End, concluded, read_story

    journal, story = read_journal(args.resume), concluded(read_story(args.resume))
    book, lost = journal.book, lost_runs(journal)
    budget = story.budget_minutes if args.budget_minutes is None else args.budget_minutes
    if story.finished(budget) and not lost and nothing_left(journal):
        return _finished(journal, story, args.json)
    bench = read_bench(book["bench"]["source"], list(book["bench"]["overrides"]))
    campaign = planned(read_plan(str(journal.folder / "plan.toml")), bench, book["seed"])
    for line in take_up(journal):
        print(line, file=sys.stderr)
    campaign = regrown(campaign, journal, story)
    refuse_nobody(campaign, journal.open_runs())
    again = replace(story, end=End.OPEN, sentence="", budget_minutes=budget)
    _refuse_beyond(campaign, journal.open_runs(), budget, float(book["rig_time_s"]) / 60)
    with showing(args.json) as show:
        return _make(campaign, journal, args.clock or book["clock"], args.note, again, show)


def _finished(journal: Journal, story: Story, json: bool) -> int:
    """Nothing is left to do: told as it ended, its book closed where the program died before it was; the exit code."""
    from rig.closing.run import exit_of, in_the_book
    from rig.closing.story import write_story

    for line in take_up(journal):
        print(line, file=sys.stderr)
    write_story(journal.folder, story)
    journal.close("completed", in_the_book(journal, story.sentence))
    with showing(json) as show:
        show.say("this loop is finished: nothing is moved")
        return _told(journal, story, exit_of(story), show)


def _refuse_beyond(campaign: Campaign, runs: Sequence[int], budget: float, spent: float) -> None:
    """Raises UsageError when the runs to begin with may take longer than the whole loop may, all in minutes."""
    todo = list(deeds([(k, campaign.items[k]) for k in runs], Rigging()))
    measuring, checking, _ = lasting(campaign, todo)
    least = spent + (measuring + checking) / 60 if runs else 0.0
    if least > budget:
        raise UsageError(
            f"--budget-minutes {budget:g}: the {len(runs)} runs of the plan and their checks take up to {least:.1f} "
            "min of rig time before the first trace; expected a budget above that, or a shorter --plan"
        )


def _make(campaign: Campaign, journal: Journal, clock: ClockName, note: str, story: Story, show: Show) -> int:
    from rig.closing.loop import Closing
    from rig.closing.run import conduct

    bench = campaign.bench
    show.bench(bench, clock)
    before = float(journal.book["rig_time_s"])
    with (
        swept(journal),
        at_the_rig(show) as (interrupts, person),
        open_session(campaign, journal, clock, interrupts, note, person, show) as session,
    ):
        show.say(f"campaign folder {journal.folder}")
        closing = Closing(
            session, campaign, journal, Terminal(bench, person, show), trace_folder,
            lambda: (before + session.instruments.clock.now()) / 60, story,
        )  # fmt: skip
        exit = conduct(closing)
    return _told(journal, closing.story, exit, show)


def _told(journal: Journal, story: Story, exit: Exit, show: Show) -> int:
    """The story on stdout and as a page; the exit code."""
    show.tell("campaign", folder=str(journal.folder), status=str(story.end), runs=journal.count())
    show.leave(exit)
    _tell(journal.folder, story, exit)
    return int(exit)


def _tell(folder: Path, story: Story, exit: Exit) -> None:
    from rig.report.closing.page import write
    from rig.report.numbers import counted

    page = write(folder)
    simulated = "SIMULATED " if story.simulated else ""
    after = counted(len(story.rounds), "round")
    print(f"{simulated}loop {story.end.replace('_', ' ')} after {after}: {story.sentence}")
    for r in story.rounds:
        done = r.words or r.refused or "nothing"
        found = " ".join([r.status.replace("_", " "), ", ".join(r.effects)]).rstrip()
        print(f"  round {r.number}, {r.minutes:.1f} min: {found}; then {done}")
    print(f"report {page}")
    if exit is Exit.STOPPED:
        print(f"hdrig close-loop --resume {shlex.quote(str(folder))} goes on with it", file=sys.stderr)
