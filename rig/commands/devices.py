"""hdrig devices: who is on the bus and on the serial ports; writes a first bench file to edit."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from rig.commands.targets import refuse_unwritable
from rig.core.errors import Exit, NotReady, UsageError
from rig.runfile.writing import writing

if TYPE_CHECKING:
    from drivers.scan import Found


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
    ports = scan_ports()
    for port in ports:
        print(f"serial  {port.path}: {port.what}" + (f", serial number {port.serial}" if port.serial else ""))
    if not ports:
        print("serial  no ports")
    if not args.channel:
        return Exit.PASS
    options = adapter_options(args.option)
    nodes = scan_bus(args.interface, args.channel, args.bitrate, options)
    for node in nodes:
        who = " ".join(part for part in node.identity if part)
        print(f"node {node.number:<3d} {node.speaks}: {who}{_plate(node)}")
    if not nodes:
        where = f"{args.interface} {args.channel} at {args.bitrate} bit/s"
        raise NotReady(f"nobody answers on {where}: wrong bitrate, no termination, no power?")
    if args.out:
        from rig.first_bench import first_bench

        text = first_bench(args.interface, args.channel, args.bitrate, nodes, options)
        with writing(args.out):
            args.out.write_text(text, encoding="utf-8")
        print(f"wrote {args.out}: replace every number that is assumed, then hdrig doctor --bench {args.out}")
    return Exit.PASS


def _refuse_taken(path: Path, channel: str) -> None:
    if not channel:
        raise UsageError("--out needs --channel: the drive is found on a CAN bus")
    if path.exists():
        raise UsageError(f"{path} exists; nothing is overwritten")
    refuse_unwritable(path.parent)


def _plate(node: Found) -> str:
    units = {"torque_rated": "N·m", "counts_per_turn": "counts/turn", "rated_step": "N·m a digit of 6076h"}
    return "".join(f", {value:g} {units[key]}" for key, value in node.plate.items() if value)
