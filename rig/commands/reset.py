"""hdrig reset: leave a fault, by an explicit act of somebody who has looked. Energises nothing."""

from __future__ import annotations

import argparse
from pathlib import Path

from rig.commands.options import bench_argument
from rig.core.errors import Exit, NotReady

NO_VOLTAGE = (
    "the drive tells of no voltage at its power stage. Some never do while they are torque-free; if a run is refused, "
    "see to its safe torque off, the hard-wired stop and its supply"
)


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig reset`."""
    bench_argument(parser, default=None)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="change a number of it")


def run(args: argparse.Namespace) -> int:
    """Connect, say what is wrong, clear it, look again; exit 3 when it comes back."""
    from rig.bench import read
    from rig.process.interrupts import Interrupts
    from rig.session import Session
    from rig.supervisor import State

    bench = read(args.bench, args.set)
    with Session(bench, "virtual" if bench.simulated else "wall", Path("runs"), Interrupts()) as session:
        mark = " (SIMULATED)" if session.simulated else ""
        if session.supervisor.state is not State.FAULT:
            print(f"{bench.file.name}{mark}: nothing to reset, no device is in fault")
            if session.instruments.drive.voltage is False:
                print(f"{bench.file.name}{mark}: {NO_VOLTAGE}")
            return Exit.PASS
        why = session.supervisor.fault
        print(f"{bench.file.name}{mark} is in fault: {why}")
        try:
            session.reset()
        except NotReady as stays:
            raise NotReady(f"{stays}; nothing was energised") from None
        print(f"{bench.file.name}{mark}: reset, no device is in fault any more; nothing is energised")
    return Exit.PASS
