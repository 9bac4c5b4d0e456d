"""hdrig devices: who is on the bus and on the serial ports; writes a first bench file to edit."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from rig.commands.targets import refuse_taken
from rig.core.errors import Exit, NotReady, UsageError
from rig.runfile.manifest import write_atomic
from rig.runfile.writing import writing

if TYPE_CHECKING:
    from drivers.scan import Found


UNTOLD = "n/a"  # pyserial's word


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig devices`."""
    parser.add_argument("--interface", default="socketcan", metavar="NAME", help="python-can's name of the CAN adapter")
    parser.add_argument(
        "--channel", default="", metavar="CHANNEL", help="its channel, can0 for example; left out: serial ports alone"
    )
    parser.add_argument("--bitrate", type=int, default=1_000_000, metavar="BIT/S", help="of the bus (1000000)")
    parser.add_argument(
        "--option",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="one more that the adapter needs, for example --option host=10.0.0.5 --option port=29536 of socketcand",
    )
    parser.add_argument(
        "-o", "--out", "--write", type=Path, metavar="FILE", help="a bench file with what was found, to edit"
    )


def run(args: argparse.Namespace) -> int:
    """Nodes, ports, and the file; exit 3 when a bus was asked for and nobody is on it."""
    from rig.first_bench import adapter_options, scan_bus, scan_ports

    if args.out:
        _refuse_taken(args.out, args.channel)
    if args.bitrate <= 0:
        raise UsageError(f"--bitrate {args.bitrate}: expected bit/s of the bus, for example 1000000")
    ports = scan_ports()
    for port in ports:
        what = port.what if port.what != UNTOLD else "a port that tells nothing of what is behind it"
        print(f"serial  {port.path}: {what}" + (f", serial number {port.serial}" if port.serial else ""))
    if not ports:
        print("serial  no ports")
    if not args.channel:
        return Exit.PASS
    options = adapter_options(args.option)
    nodes = scan_bus(args.interface, args.channel, args.bitrate, options)
    for node in nodes:
        who = " ".join(part for part in node.identity if part)
        mark = "SIMULATED " if node.identity.simulated else ""
        print(f"{mark}node {node.number:<3d} {node.speaks}: {who}{_plate(node)}")
    if not nodes:
        where = f"{args.interface} {args.channel} at {args.bitrate} bit/s"
        raise NotReady(f"nobody answers on {where}: wrong bitrate, no termination, no power?")
    if args.out:
        from rig.first_bench import first_bench

        text = first_bench(args.interface, args.channel, args.bitrate, nodes, options)
        with writing(args.out):
            write_atomic(args.out, text.encode())
        print(f"wrote {args.out}: replace every number that is assumed, then hdrig doctor --bench {args.out}")
    return Exit.PASS


def _refuse_taken(path: Path, channel: str) -> None:
    if not channel:
        raise UsageError("--out needs --channel: the drive is found on a CAN bus")
    refuse_taken(path, "--out")


def _plate(node: Found) -> str:
    units = {"torque_rated": "N·m", "counts_per_turn": "counts/turn", "rated_step": "N·m a digit of 6076h"}
    return "".join(f", {value:g} {units[key]}" for key, value in node.plate.items() if value)
