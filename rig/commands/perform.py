"""Proof, run, analysis, report, for the verbs that move something; and what is printed at the end."""

from __future__ import annotations

import sys
from pathlib import Path

from rig.bench import Bench, ClockName
from rig.commands.analyse import analyse_folder, exit_of, print_result
from rig.commands.progress import Progress
from rig.core.errors import Exit
from rig.core.procedure import Procedure
from rig.interrupts import Interrupts
from rig.procedures.sign_and_scale import SignAndScale
from rig.session import Done, Session


def perform(bench: Bench, clock: ClockName, procedure: Procedure, root: Path, note: str) -> int:
    """One procedure to the end, its figures on stdout; the exit code. Ctrl-C once = stop, twice = halt."""
    if bench.simulated:
        print(f"SIMULATED: bench '{bench.file.name}' is the twin, {clock} clock", file=sys.stderr)
    with Interrupts() as interrupts, Session(bench, clock, root, interrupts, note) as session:
        session.check(procedure)
        if not isinstance(procedure, SignAndScale):
            print(f"sign and scale: {session.prove().sentence}", file=sys.stderr)
        done = _watched(session, procedure)
    # torque is off and the run is closed: from here Ctrl-C only ends the analysis
    print(f"run {done.ending.status}: {done.ending.reason}", file=sys.stderr)
    result = analyse_folder(done.folder, done.folder)
    print_result(result, done.folder, done.folder)
    return int(done.ending.exit or exit_of(result) or Exit.PASS)


def _watched(session: Session, procedure: Procedure) -> Done:
    envelope = procedure.envelope(session.bench.setting(lambda text: None))
    with Progress(procedure.name.replace("_", " "), envelope.duration, session.bench.file.gear.N) as progress:
        return session.run(procedure, progress.watch)
