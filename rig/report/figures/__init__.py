"""The catalogue of figures: one figure, one file, one line here; each drawn alone to SVG or PNG from a result's curves.

A figure whose curves are absent is None, never an empty frame.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager

import matplotlib as mpl

from rig.process.ctrl_c import uninterrupted
from rig.report.palette import LIGHT
from rig.report.without_help import without_help

with without_help():
    from rig.report.figures import (
        coast_down,
        convergence,
        creep,
        decomposition,
        friction,
        full_turn,
        kinematic_error,
        loads,
        local_stiffness,
        lock,
        loop_rate,
        orders,
        spectrum,
        speed_convergence,
        split,
        timeline,
        torsion,
    )
    from rig.report.figures.canvas import STYLE, Curves, Drawing, Frame
    from rig.report.figures.renderer import drawn
    from rig.report.figures.svg import dress

__all__ = ["CATALOGUE", "Drawing", "Frame", "png", "styled", "svg"]


CATALOGUE: tuple[Drawing, ...] = (
    kinematic_error.DRAWING,
    orders.DRAWING,
    spectrum.DRAWING,
    convergence.DRAWING,
    split.DRAWING,
    decomposition.DRAWING,
    decomposition.ORDERS,
    full_turn.DRAWING,
    full_turn.LINES,
    loads.DRAWING,
    speed_convergence.DRAWING,
    coast_down.DRAWING,
    friction.DRAWING,
    torsion.DRAWING,
    lock.DRAWING,
    local_stiffness.DRAWING,
    loop_rate.DRAWING,
    creep.DRAWING,
    timeline.DRAWING,
)


@contextmanager
def styled() -> Iterator[None]:
    """The look of all figures; entered once for many, for matplotlib checks every setting each time: a millisecond."""
    if mpl.rcParams["svg.hashsalt"] == STYLE["svg.hashsalt"]:  # it is there
        yield
        return
    with mpl.rc_context(STYLE):
        yield


@contextmanager
def drawing_whole() -> Iterator[None]:
    """As `styled`, and an interrupt waits for the figure: in matplotlib's C it becomes an error of another kind."""
    with styled(), uninterrupted():
        yield


def svg(drawing: Drawing, curves: Curves, frame: Frame | None = None, *, prefix: str | None = None) -> str | None:
    """The figure as an <svg> element, or None when its curves are absent.

    Without `prefix` it is a file of its own in light colours; with one it is part of a page: ids begin with it, colours
    are the page's variables, width is the page's to set.
    """
    with drawing_whole():
        figure = drawing.draw(curves, frame or Frame())
        if figure is None:
            return None
        text = drawn(figure)
    return dress(text, prefix or "", drawing.say(curves), themed=prefix is not None)


def png(drawing: Drawing, curves: Curves, frame: Frame | None = None, *, scale: float = 2.0) -> bytes | None:
    """The figure as PNG on white, `scale` dots per CSS pixel; None when its curves are absent."""
    data = io.BytesIO()
    with drawing_whole():
        figure = drawing.draw(curves, frame or Frame())
        if figure is None:
            return None
        figure.savefig(data, format="png", dpi=72 * scale, facecolor=LIGHT["paper"], metadata={"Software": None})
    return data.getvalue()
