"""Proof, run, analysis, report, for the verbs that move something; and what is printed at the end."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rig.bench import Bench, ClockName
from rig.commands.analyse import print_result
from rig.commands.show.at_the_rig import at_the_rig
from rig.commands.show.onlookers import Onlookers
from rig.commands.show.show import Show
from rig.commands.targets import refuse_unwritable
from rig.core.errors import DataError, Exit, UsageError
from rig.core.operator import LockOutput
from rig.core.procedure import Procedure
from rig.evaluation.run import analyse_folder, exit_of
from rig.evaluation.step_test import response_of
from rig.procedures.step_test import StepTest
from rig.report.record import as_json
from rig.runfile.manifest import read
from rig.session import Done, Session
from rig.session.observer import Observer
from rig.supervisor import State


def let_be(session: Session, show: Show) -> None:
    """Nothing is done before the run."""


def clear(session: Session, show: Show) -> None:
    """Leave a latched fault, because somebody has looked and says so. Energises nothing. Raises NotReady."""
    if session.supervisor.state is State.FAULT:
        show.say(f"{session.bench.file.name} is in fault: {session.supervisor.fault}")
        session.reset()
        show.say(f"{session.bench.file.name}: reset, no device is in fault any more; every check is made anew")


@dataclass(frozen=True)
class Job:
    """One procedure on one bench."""

    bench: Bench
    clock: ClockName
    procedure: Procedure
    root: Path
    note: str
    before: Callable[[Session, Show], None] = let_be  # what is done once connected, before anything moves
    limits: Mapping[str, Any] = field(default_factory=dict)  # the figures' own; kept in the run's manifest


def perform(job: Job, show: Show, looking_on: Observer) -> int:
    """One procedure to the end, its figures on stdout; the exit code. Raises UsageError where nothing can be kept."""
    refuse_unwritable(job.root)
    done, interrupted = _recorded(job, show, looking_on)
    # torque is off and the run is closed: from here Ctrl-C only ends the analysis
    show.say(f"run {done.ending.status}: {done.ending.reason}")
    if done.ending.exit is Exit.PASS and (told := finding(job.procedure, done)):
        show.tell("figure", folder=str(done.folder), text=told)
        show.leave(Exit.PASS)
        print(f"{simulated_line(done.folder)}{told}\nrun folder {done.folder}")
        return int(Exit.PASS)
    try:
        if interrupted and not done.ending.exit:  # asked for when nothing was left of the run to end
            raise KeyboardInterrupt
        result, simulated = analyse_folder(done.folder, done.folder)
    except KeyboardInterrupt:
        show.say(f"{_kept(done)}; hdrig analyse makes its report")
        if not done.ending.exit:
            raise
        return show.leave(done.ending.exit)  # the run had ended so before anybody interrupted its report
    except UsageError as error:  # a disk that filled up, as it is: nothing of the run is lost
        raise DataError(f"{_kept(done)}, its report is not: {error}") from None
    show.result(done.folder, as_json(result), simulated)
    code = show.leave(done.ending.exit or exit_of(result) or Exit.PASS)
    print_result(result, done.folder, done.folder, simulated)
    return code


def _kept(done: Done) -> str:
    """Where the run is; one that did not come to its end is not called complete."""
    said = "is complete" if done.ending.exit is Exit.PASS else f"is kept, {done.ending.status},"
    return f"the run {said} in {done.folder}"


def _recorded(job: Job, show: Show, looking_on: Observer) -> tuple[Done, bool]:
    """Proof, changes by hand, the run; and whether a signal asked for an end. Ctrl-C once = stop, twice = halt; keys as
    in `show.keys`."""
    show.bench(job.bench, job.clock)
    observer = Onlookers(show, looking_on)
    with (
        at_the_rig(show) as (interrupts, person),
        Session(job.bench, job.clock, job.root, interrupts, job.note, person, observer=observer) as session,
    ):
        job.before(session, show)
        session.check(job.procedure)
        if job.procedure.closes_loop:
            show.say("the motor is about to turn: sign-and-scale proof, one turn forth and back")
            show.say(f"sign and scale: {session.prove().sentence}")
        elif said := job.procedure.announcement(job.bench.setting(lambda text: None)):
            show.say(said)
        if job.procedure.output_locked:
            show.say(session.change(LockOutput()))
        for remark in job.procedure.remarks(job.bench.setting(lambda text: None)):
            show.say(remark)
        if job.limits:
            session.facts["limits"] = dict(job.limits)
        done = session.run(job.procedure)
    return done, interrupts.signalled


def simulated_line(folder: Path) -> str:
    """What stands above the figures of a run on the twin, over whatever wire; "" of a real one."""
    return f"SIMULATED {folder.name}\n" if read(folder).get("backend") == "sim" else ""


def finding(procedure: Procedure, done: Done) -> str:
    """What a procedure with an answer of its own found; "" when the analysis gives it."""
    match procedure:
        case StepTest():
            return response_of(done.folder).sentence
        case _:
            return str(done.ending.finding.sentence) if procedure.answers else ""
