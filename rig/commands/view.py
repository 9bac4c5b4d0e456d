"""hdrig view RUN: a run in the viewer, one that goes on among them; or as a file for it."""

from __future__ import annotations

import argparse
import contextlib
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from rig.commands.folders import say_simulated
from rig.commands.targets import refuse_taken
from rig.core.errors import NotReady, UsageError

BEAT = 0.5  # s between looks whether the page is still wanted


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig view`."""
    parser.add_argument("run", type=Path, metavar="RUN", help="run folder, of any logger; one that goes on is followed")
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--web", action="store_const", const="web", dest="where", help="a page, until Ctrl-C")
    where.add_argument("--native", action="store_const", const="native", dest="where", help="a window, until it closes")
    where.add_argument(
        "-o",
        "--out",
        type=Path,
        metavar="FILE",
        help="a recording in this new file; default: view.rrd in the run folder, made anew",
    )


def run(args: argparse.Namespace) -> int:
    """Shows it, or prints where the recording is."""
    from rig.runfile.doubt import refuse_changed
    from rig.runfile.manifest import read
    from rig.runfile.process import is_being_made

    manifest = read(args.run)
    goes_on = is_being_made(manifest)
    if not goes_on:
        refuse_changed(args.run, manifest)
    if args.where is None:
        if goes_on:
            raise UsageError(f"{args.run} is still being made: --web or --native follows it, a file is made afterwards")
        if args.out is not None:
            refuse_taken(args.out, "--out")
        say_simulated(args.run, manifest)
        return _record(args.run, args.out)
    say_simulated(args.run, manifest)
    return _follow(args.run, args.where) if goes_on else _show(args.run, args.where)


def _record(folder: Path, out: Path | None) -> int:
    from rig.live.view.recording import NAME, record

    path = out or folder / NAME
    record(folder, path)
    print(path)
    return 0


def _follow(folder: Path, where: str) -> int:
    """The bridge as `hdrig run` has it, until Ctrl-C or until the window is closed."""
    from rig.live.view.viewer import Viewer

    with Viewer(where) as viewer:
        viewer.follow(folder)
        with _until_asked():
            _say(viewer.url)  # what it says holds from then on
            while viewer.runs:
                time.sleep(BEAT)
    return 0


def _show(folder: Path, where: str) -> int:
    """A run that is over, whole."""
    from rig.live.view.about import about
    from rig.live.view.pages import Pages
    from rig.live.view.recording import draw
    from rig.live.view.rerun_canvas import WHOLE, Gone, RerunCanvas, Stalled
    from rig.live.view.server import Proxy, Window
    from rig.runfile.run import Run

    recorded, said = Run.open(folder), about(folder)
    server = Proxy() if where == "web" else Window()
    server.start()
    try:
        canvas = RerunCanvas.to_viewer(said, server.url, *WHOLE)
        draw(recorded, said, canvas)
        canvas.flush(60.0)  # s: 10 MB to a process on this machine
        canvas.close()  # the server has it all; the SDK would complain in lines of its own once that is gone
        page = Pages(server.port, lambda: server.starts).url if where == "web" else ""
        with _until_asked():
            _say(page)
            while server.runs:
                time.sleep(BEAT)
    except (Gone, Stalled) as error:
        raise NotReady(f"the viewer does not take the run: {error}") from error
    finally:
        server.stop()
    return 0


@contextlib.contextmanager
def _until_asked() -> Iterator[None]:
    """Ctrl-C is the way to end it, and no error."""
    with contextlib.suppress(KeyboardInterrupt):
        yield


def _say(url: str) -> None:
    if url:
        print(f"{url}\nCtrl-C ends it", file=sys.stderr)
