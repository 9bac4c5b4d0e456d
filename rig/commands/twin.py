"""hdrig twin: the simulated rig as a process of its own that real drivers reach over CAN and serial lines."""

from __future__ import annotations

import argparse
import contextlib
import math
import signal
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from rig.bench import Bench, read, twin_parameters
from rig.commands.ask_twin import HELP, ask
from rig.commands.targets import refuse_unwritable
from rig.core.errors import Exit, UsageError
from rig.process.realtime import RealTime

if TYPE_CHECKING:
    from sim.wire.assembly import Assembly
    from sim.wire.process import Process

USUAL = 3.0  # s that a start takes at most where nothing has to be compiled
SLOW = "starting: the plant is being compiled, as on the first start on a machine; ten seconds or more"
FOLDER = Path("/tmp/hdrig-twin")
MOST_LINES = 900.0  # lines/s, 12 bytes each, that a line of 115 200 baud carries


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig twin`."""
    parser.add_argument(
        "ask", nargs="*", metavar="ASK", help="of one that runs already: free, lock, hang 3, status … (see below)"
    )
    parser.add_argument("--bench", default="twin", metavar="FILE", help="bench file with a [twin] section")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="change a number of it")
    parser.add_argument("--bus", type=Path, default=FOLDER / "can", metavar="PATH", help="socket of the CAN bus")
    parser.add_argument("--serial", type=Path, metavar="DIR", help="also serial devices: links DIR/torque and DIR/qsb")
    parser.add_argument("--rate", type=float, default=100.0, metavar="HZ", help="lines/s of the serial torque sensor")
    parser.add_argument("--slcan", type=Path, metavar="PATH", help="also a serial CAN adapter, a link to its pty")
    parser.add_argument("--socketcand", type=int, metavar="PORT", help="also the bus over TCP; 0: a free port")
    parser.add_argument(
        "--odrive", type=Path, metavar="PATH", help="also an ODrive, on a CAN bus of its own: its socket"
    )
    parser.add_argument("--control", type=Path, default=FOLDER / "control", metavar="PATH", help="command channel")
    parser.add_argument("--bitrate", type=float, default=1e6, metavar="BIT/S", help="of the bus; inf: takes no time")
    parser.add_argument("--for", type=float, default=math.inf, dest="seconds", metavar="SECONDS", help="then stop")
    parser.epilog = HELP


def run(args: argparse.Namespace) -> int:
    """Serve until SIGTERM, SIGINT, `stop` on the command channel or the time is up; or ask one that does."""
    if args.ask:
        print("\n".join(ask(args.control, args.ask)))
        return Exit.PASS
    if not args.bitrate > 0.0:
        raise UsageError(f"--bitrate {args.bitrate:g}: expected more than 0 bit/s, for example 1e6")
    if not 0.0 <= args.rate <= MOST_LINES:
        raise UsageError(f"--rate {args.rate:g}: expected 0 to {MOST_LINES:g} lines/s")
    if not args.seconds >= 0.0:
        raise UsageError(f"--for {args.seconds:g}: expected 0 s or more, for example 60")
    bench = read(args.bench, args.set)
    if bench.file.twin is None:
        raise UsageError(f"{bench.source} has no [twin] section: there is nothing to simulate")
    refuse_no_place(args)
    print(f"SIMULATED: bench '{bench.file.name}' is the twin, seed {bench.file.twin.seed}, in real time", flush=True)
    with told_if_slow():
        assembly, process = started(bench, args)
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: process.reactor.stop())
    assembly.agenda.at(args.seconds, process.reactor.stop)
    for line in process.lines:
        print(line, flush=True)
    print("ready", flush=True)
    with RealTime():  # devices answer in time whatever else runs on the machine
        process.run()
    return Exit.PASS


@contextlib.contextmanager
def told_if_slow() -> Iterator[None]:
    """A start that takes longer than usual says on stderr why."""
    timer = threading.Timer(USUAL, print, (SLOW,), {"file": sys.stderr, "flush": True})
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def started(bench: Bench, args: argparse.Namespace) -> tuple[Assembly, Process]:
    """The rig behind its buses and lines, ready to run."""
    from sim.wire.assembly import Assembly
    from sim.wire.motor import Rating
    from sim.wire.process import Doors, Process
    from sim.world import MOST_LOAD

    assert bench.file.twin is not None
    rating = Rating(bench.file.motor.torque_rated)
    assembly = Assembly(twin_parameters(bench.file), bench.file.twin.seed, rating, args.bitrate)
    doors = Doors(args.bus, args.control, args.serial, args.slcan, args.socketcand, args.rate, args.odrive)
    return assembly, Process(assembly, doors, bench.limits.shaft_torque or MOST_LOAD)


def refuse_no_place(args: argparse.Namespace) -> None:
    """Raises UsageError where a socket or a link that was asked for cannot be made, before anything is."""
    for option in ("bus", "control", "slcan", "odrive"):
        if (path := getattr(args, option)) is not None:
            refuse_unwritable(path.parent, f"--{option}")
    if args.serial is not None:
        refuse_unwritable(args.serial, "--serial")
