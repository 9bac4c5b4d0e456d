"""Proof, run, analysis, report, for the verbs that move something; and what is printed at the end."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from rig.bench import Bench, ClockName
from rig.commands.analyse import analyse_folder, exit_of, print_result
from rig.commands.person import Person
from rig.commands.progress import Progress
from rig.core.errors import Exit
from rig.core.operator import LockOutput
from rig.core.procedure import Procedure
from rig.interrupts import Interrupts
from rig.procedures.lock_check import LockCheck
from rig.procedures.sign_and_scale import SignAndScale
from rig.procedures.step_test import StepTest
from rig.procedures.weigh import Weigh
from rig.session import Done, Session
from rig.session.observer import Observer

if TYPE_CHECKING:
    from rig.analysis.step_response import StepResponse


def perform(
    bench: Bench, clock: ClockName, procedure: Procedure, root: Path, note: str, observer: Observer | None = None
) -> int:
    """One procedure to the end, its figures on stdout; the exit code. Ctrl-C once = stop, twice = halt."""
    if bench.simulated:
        print(f"SIMULATED: bench '{bench.file.name}' is the twin, {clock} clock", file=sys.stderr)
    with (
        Interrupts() as interrupts,
        Session(bench, clock, root, interrupts, note, Person(interrupts), observer=observer or Observer()) as session,
    ):
        session.check(procedure)
        if procedure.closes_loop:
            print("the motor is about to turn: sign-and-scale proof, one turn forth and back", file=sys.stderr)
            print(f"sign and scale: {session.prove().sentence}", file=sys.stderr)
        if procedure.output_locked:
            print(session.change(LockOutput()), file=sys.stderr)
        for remark in procedure.remarks(bench.setting(lambda text: None)):
            print(remark, file=sys.stderr)
        done = _watched(session, procedure)
    # torque is off and the run is closed: from here Ctrl-C only ends the analysis
    print(f"run {done.ending.status}: {done.ending.reason}", file=sys.stderr)
    if done.ending.exit is Exit.PASS and (told := finding(procedure, done)):
        print(f"{told}\nrun folder {done.folder}")
        return int(Exit.PASS)
    try:
        result, simulated = analyse_folder(done.folder, done.folder)
    except KeyboardInterrupt:
        print(f"the run is complete in {done.folder}; hdrig analyse makes its report", file=sys.stderr)
        raise
    print_result(result, done.folder, done.folder, simulated)
    return int(done.ending.exit or exit_of(result) or Exit.PASS)


def finding(procedure: Procedure, done: Done) -> str:
    """What a procedure with an answer of its own found; "" when the analysis gives it."""
    match procedure:
        case SignAndScale() | Weigh() | LockCheck():
            return str(done.ending.finding.sentence)
        case StepTest():
            return response_of(done.folder).sentence
        case _:
            return ""


def response_of(folder: Path) -> StepResponse:
    """Inertia and friction from a recorded step test."""
    from rig.analysis.step_response import step_response
    from rig.runfile.run import Run

    run = Run.open(folder)
    return step_response(run.need("t"), run.need("theta_m"), run.need("tau_applied"))


def _watched(session: Session, procedure: Procedure) -> Done:
    envelope = procedure.envelope(session.bench.setting(lambda text: None))
    with Progress(procedure.title(), envelope.duration, session.bench.file.gear.N) as progress:
        return session.run(procedure, progress.watch)
