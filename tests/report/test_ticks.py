"""Panels that move one tick along draw what matplotlib's own axes draw, to the last stroke."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, MaxNLocator, NullLocator

from rig.report.figures.canvas import STYLE, Frame, log_axis, sheet
from rig.report.figures.renderer import drawn
from rig.report.figures.ticks import Panel


def turned_round(panel: Any) -> None:
    panel.set_xlim(5.0, -1.0)


def by_decades(panel: Any) -> None:
    log_axis(panel, 0.02, 300.0)


def with_an_offset(panel: Any) -> None:
    panel.plot([0.0, 1.0], [1e7 + 1e-3, 1e7 + 2e-3])
    panel.set_ylim(1e7, 1e7 + 3e-3)


def with_minor_ticks(panel: Any) -> None:
    panel.xaxis.set_minor_locator(MaxNLocator(40))


def named_and_without_labels(panel: Any) -> None:
    panel.set_xlabel("Time, s")
    panel.tick_params(axis="x", labelbottom=False)
    panel.yaxis.set_major_locator(NullLocator())


def beyond_the_view(panel: Any) -> None:
    panel.xaxis.set_major_locator(FixedLocator([-9.0, 0.0, 0.1 + 0.2, 4.0, 1e9]))


def hidden(panel: Any) -> None:
    panel.xaxis.set_visible(False)


def svg(kind: type[Axes], change: Callable[[Any], None]) -> str:
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(5, 3), dpi=72)
        panel: Any = figure.add_axes((0.1, 0.1, 0.8, 0.8), axes_class=kind)
        panel.plot(np.linspace(0.0, 4.0, 50), np.sin(np.linspace(0.0, 4.0, 50)))
        change(panel)
        return drawn(figure)


@pytest.mark.slow
@pytest.mark.parametrize(
    "change",
    [turned_round, by_decades, with_an_offset, with_minor_ticks, named_and_without_labels, beyond_the_view, hidden],
)
def test_a_panel_is_drawn_as_by_matplotlib(change: Callable[[Any], None]) -> None:
    assert svg(Panel, change) == svg(Axes, change)


def test_each_axis_makes_one_tick() -> None:
    figure, (panel,) = sheet(Frame(), [200.0])
    drawn(figure)
    assert len(panel.xaxis.get_majorticklocs()) > 3
    assert len(panel.xaxis.majorTicks) == len(panel.yaxis.majorTicks) == 1
