"""hdrig serve: the operator's page, and the control process behind it."""

from __future__ import annotations

import argparse
import asyncio
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

from rig.commands.targets import refuse_unwritable
from rig.core.errors import Exit
from rig.runfile.writing import writing

if TYPE_CHECKING:
    from rig.live.view.viewer import Viewer


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig serve`."""
    parser.add_argument("--bench", default="twin", metavar="FILE", help="offered first; connected by a click")
    parser.add_argument("--host", default="127.0.0.1", metavar="ADDRESS", help="default 127.0.0.1: this machine alone")
    parser.add_argument("--port", type=int, default=8765, metavar="N", help="default 8765; 0: a free one")
    parser.add_argument("-o", "--out", type=Path, default=Path("runs"), metavar="FOLDER", help="where run folders go")
    parser.add_argument("--view", choices=("none", "web"), default="none", help="the live view as a part of the page")
    parser.add_argument(
        "--name", action="append", default=[], metavar="NAME", help="what a proxy that ends TLS calls this server"
    )


def run(args: argparse.Namespace) -> int:
    """Serve until Ctrl-C, which brings the motor to rest first; twice takes the torque off."""
    from rig.bench import read
    from rig.console.server import Serving

    read(args.bench)  # what is wrong with it is said now
    refuse_unwritable(args.out)
    with writing(args.out):
        args.out.mkdir(parents=True, exist_ok=True)
    with _viewer(args.view) as viewer:
        serving = Serving(args.host, args.port, args.out, args.bench, tuple(args.name), viewer)
        for line in serving.lines:
            print(line, flush=True)
        asyncio.run(serving.run())
    return Exit.PASS


def _viewer(kind: str) -> AbstractContextManager[Viewer | None]:
    """The live view beside the page; it is loopback's alone, whatever the page is."""
    from rig.live.view.viewer import Viewer

    return Viewer(kind) if kind == "web" else nullcontext()
