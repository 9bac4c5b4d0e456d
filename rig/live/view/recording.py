"""A run folder as a recording of the viewer: derived, disposable, made again whenever somebody wants it."""

from __future__ import annotations

import contextlib
import os
import shutil
from pathlib import Path

from rig.core.channels import CHANNEL
from rig.core.errors import UsageError
from rig.live.view.about import About, about
from rig.live.view.block import Block, of_run
from rig.live.view.canvas import Canvas
from rig.live.view.curves import measured_in, others
from rig.live.view.picture import Picture
from rig.runfile.events import read_events
from rig.runfile.run import Run

NAME = "view.rrd"
ROWS = 60_000  # of a curve in a recording, about 9 MB: far more than any screen has; all rows stay in the run
PICTURES = 1000  # moments at which planes and rig are drawn: more make the file large and scrubbing no finer
CHUNK = 20_000  # rows sent at once


def record(folder: Path, path: Path) -> None:
    """Draw the run in `folder` into `path`, which is there whole or not at all.

    Raises UsageError when the folder is no run or the file cannot be made.
    """
    from rig.live.view.rerun_canvas import Gone, RerunCanvas, Stalled

    run, said = Run.open(folder), about(folder)
    part = path.with_name(path.name + ".part")
    try:
        canvas = RerunCanvas.to_file(said, part)
        draw(run, said, canvas)
        canvas.flush(60.0)  # s: a file
        canvas.close()
        os.replace(part, path)
    except OSError as error:
        raise UsageError(f"{path} cannot be written: {error.strerror}; name another place with --out") from error
    except (Gone, Stalled):  # the SDK does not say why
        free = shutil.disk_usage(path.parent).free
        raise UsageError(
            f"{path} cannot be written: the disk is full, or a file may not be so large; {free / 1e6:.1f} MB were free "
            "when it stopped; name another place with --out"
        ) from None
    finally:
        with contextlib.suppress(OSError):  # a place that cannot be written was told of
            part.unlink(missing_ok=True)


def draw(run: Run, said: About, canvas: Canvas) -> None:
    """The whole run on a canvas."""
    block = of_run(run)
    if not len(block):
        raise UsageError(f"{run.name} has no row with a time: there is nothing to draw")
    more = others({name: run.unit(name) or "no unit said" for name in run.channels if name not in CHANNEL})
    measured = measured_in(block, said.ratio, more)
    span = (float(block.t[0]), float(block.t[-1]))
    picture = Picture(said, 2 * -(-len(block) // ROWS), span, measured, more)
    picture.begin(canvas)
    for event in read_events(run.path):
        picture.event(event, canvas)
    for chunk in block.slices(CHUNK):
        picture.curves(chunk, canvas)
    for chunk in _moments(block):
        picture.draw(chunk, canvas)
    picture.over(canvas)


def _moments(block: Block) -> list[Block]:
    """Blocks of 0.1 s or longer, at most PICTURES of them."""
    span = float(block.t[-1] - block.t[0])
    count = int(min(PICTURES, max(span / 0.1, 1), len(block)))
    return list(block.slices(-(-len(block) // count)))
