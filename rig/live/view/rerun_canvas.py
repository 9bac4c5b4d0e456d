"""The only module that knows rerun: the canvas as a rerun recording, into a file or to a viewer."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

os.environ.setdefault("RUST_LOG", "off")  # read when it is imported: its raw lines stood around our sentences
import rerun as rr
import rerun.blueprint as rrb
from rerun.blueprint import encodings

from rig.live.view import colours
from rig.live.view.about import About
from rig.live.view.axes import bounds
from rig.live.view.canvas import Canvas, Pen, Solid
from rig.live.view.layout import PAST, Group, Kind, Layout, Pane

Array = np.ndarray[Any, Any]
Span = tuple[float, float] | None

TIMELINE = "rig_time"
EYE = (-116.0, -132.0, 64.0)  # mm: from the side of the motor, so that the wave generator is seen inside the cup
LOOK = (4.0, 0.0, 2.0)
WHOLE = 60.0, 2000  # s and rows gathered of a run that is over
DOT = 4.0  # px, radius


class Gone(Exception):
    """Nothing said on this stream will be heard any more: its viewer was killed."""


class Stalled(Exception):
    """The viewer does not take what it is sent, and may again later."""


class RerunCanvas(Canvas):
    """One recording. `to_file` or `to_viewer` makes it; `close` ends it."""

    def __init__(self, about: About, gathered: float, turns: int) -> None:
        """What is logged waits `gathered` s, of each angle `turns` rows, before it goes: pieces cost the viewer."""
        # a blueprint belongs to an application id: one for every kind of procedure
        name = f"hdrig {'SIMULATED ' if about.simulated else ''}{_ascii(about.title)}"
        config = rr.ChunkBatcherConfig(flush_tick=gathered)
        self._stream = rr.RecordingStream(name, recording_id=about.uid, batcher_config=config)
        self._turns, self._turned = turns, dict[str, list[tuple[Array, Array]]]()
        self._about = about
        self._times: tuple[Array, rr.TimeColumn] | None = None  # the last ones, of several paths in turn

    @classmethod
    def to_file(cls, about: About, path: Path) -> RerunCanvas:
        """A recording in a file of its own. Raises OSError when the file cannot be made."""
        with open(path, "wb"):  # the stream itself only warns
            pass
        canvas = cls(about, *WHOLE)
        canvas._stream.set_sinks(rr.FileSink(str(path)))
        canvas._name()
        return canvas

    @classmethod
    def to_viewer(cls, about: About, url: str, gathered: float = 0.05, turns: int = 1) -> RerunCanvas:
        """A recording in the viewer behind `url`, followed as it grows; a run that is over goes in large pieces."""
        canvas = cls(about, gathered, turns)
        canvas._stream.set_sinks(rr.GrpcSink(url))
        canvas._name()
        return canvas

    def _name(self) -> None:
        about = self._about
        name = " ".join(part for part in (about.banner, about.title, about.gear, about.started[:19]) if part)
        self._stream.send_recording_name(name)
        said = {"gear": about.gear, "ratio": about.ratio, "simulated": about.simulated, "folder": about.folder}
        self._stream.send_property("hdrig", rr.AnyValues(**said))

    def flush(self, within: float) -> None:
        """Everything handed over. Raises Stalled when it is not after `within` s, Gone when nobody takes it."""
        for path in self._turned:
            self._send_turns(path)
        try:
            self._stream.flush(timeout_sec=within)
        except RuntimeError as error:  # the SDK has one kind for both
            raise Stalled(str(error)) if "timed out" in str(error) else Gone(str(error)) from error

    def close(self) -> None:
        """No more. Idempotent."""
        self._stream.disconnect()

    # ---------------------------------------------------------------- what is drawn

    def arrange(self, layout: Layout) -> None:
        """Panes as a blueprint, sent at once."""
        self._stream.send_blueprint(_blueprint(layout))

    def name_curves(self, path: str, names: Sequence[str], colours: Sequence[int]) -> None:
        """Names and 0xRRGGBB colours of the columns that follow on this path; curves are thinned by extremes."""
        style = rr.SeriesLines(
            names=names, colors=_rgba(colours), widths=[1.5] * len(names), aggregation_policy="MinMax"
        )
        self._stream.log(path, style, static=True)

    def curves(self, path: str, t: Array, values: Array) -> None:
        """A column send: t (n,) s, values (n, k)."""
        n, k = values.shape
        scalars = rr.components.ScalarBatch(np.ascontiguousarray(values).ravel())
        self._send(path, t, rr.Scalars.descriptor_scalars(), scalars, np.arange(n + 1, dtype=np.int32) * np.int32(k))

    def _send(self, path: str, t: Array, what: Any, batch: Any, ends: Array) -> None:
        """A batch in parts that end where `ends` (n + 1,) says, at `t` (n,) s. Not by an archetype, which parts it
        twice; and times that several paths have are made once: a block of 50 rows costs what is done for each path."""
        if self._times is None or self._times[0] is not t:
            self._times = t, rr.TimeColumn(TIMELINE, duration=np.asarray(t, dtype=np.float64))
        column = rr.ComponentColumn(what, batch, offsets=ends)
        self._stream.send_columns(path, indexes=[self._times[1]], columns=[column])

    def lines(self, path: str, t: float | None, lines: Sequence[Array], pen: Pen) -> None:
        """2D strips, each (n, 2); rerun keeps the last ones for every time."""
        width = -pen.width / 2  # negative: rerun's way to say pixels
        self._log(path, t, rr.LineStrips2D(lines, colors=_rgba([pen.colour]), radii=width, draw_order=pen.order))

    def words(self, path: str, t: float | None, where: Array, words: Sequence[str], colour: int) -> None:
        """Labels without points at (n, 2)."""
        self._log(
            path,
            t,
            rr.Points2D(where, labels=words, show_labels=True, radii=0.0, colors=_rgba([colour]), draw_order=9.0),
        )

    def dot(self, path: str, t: float | None, where: Array, colour: int) -> None:
        """One point at (1, 2), DOT px, or none."""
        self._log(path, t, rr.Points2D(where, radii=-DOT, colors=_rgba([colour]), draw_order=8.0))

    def bars(self, path: str, t: float | None, at: Array, values: Array, colour: int) -> None:
        """A bar chart, bars four fifths of their distance wide."""
        width = float(at[1] - at[0]) * 0.8 if len(at) > 1 else 0.8
        self._log(path, t, rr.BarChart(values, abscissa=at, widths=[width], color=_rgba([colour])))

    def solid(self, path: str, solid: Solid) -> None:
        """A cylinder along x, mm, without a time."""
        upright = rr.RotationAxisAngle([0.0, 1.0, 0.0], degrees=90.0)  # rerun's stand along z
        body = rr.Cylinders3D(
            lengths=[solid.length],
            radii=[solid.radius],
            centers=[[solid.x, 0.0, 0.0]],
            rotation_axis_angles=[upright],
            colors=_rgba([solid.colour]),
            fill_mode="solid",
        )
        self._stream.log(path, body, static=True)

    def disc(self, path: str, half_axes: tuple[float, float, float], colour: int) -> None:
        """An ellipsoid, half axes in mm, without a time."""
        body = rr.Ellipsoids3D(half_sizes=[half_axes], colors=_rgba([colour]), fill_mode="solid")
        self._stream.log(path, body, static=True)

    def wires(self, path: str, t: float | None, wires: Sequence[Array], pen: Pen) -> None:
        """3D strips, each (n, 3) mm; the pen's width is mm."""
        self._log(path, t, rr.LineStrips3D(wires, colors=_rgba([pen.colour]), radii=pen.width))

    def signs(self, path: str, where: Array, words: Sequence[str], colour: int) -> None:
        """Labels at (n, 3) mm, without a time."""
        points = rr.Points3D(where, labels=words, show_labels=True, radii=0.01, colors=_rgba([colour]))
        self._stream.log(path, points, static=True)

    def turn(self, path: str, t: Array, angle: Array) -> None:
        """Kept until there are as many rows as the canvas gathers, then sent: t (n,) s, angle (n,) rad about x."""
        kept = self._turned.setdefault(path, [])
        kept.append((t, angle))
        if sum(len(piece) for piece, _ in kept) >= self._turns:
            self._send_turns(path)

    def _send_turns(self, path: str) -> None:
        kept = self._turned[path]
        if not kept:
            return
        t, half = (np.concatenate(parts) for parts in zip(*kept, strict=True))
        half = half / 2
        kept.clear()
        quaternions = np.stack((np.sin(half), 0 * half, 0 * half, np.cos(half)), axis=1)
        # positive as seen from the motor: about +x, y towards z
        turned = rr.components.RotationQuatBatch(quaternions)
        self._send(path, t, rr.Transform3D.descriptor_quaternion(), turned, np.arange(t.size + 1, dtype=np.int32))

    def event(self, path: str, t: float, level: str, text: str) -> None:
        """A line of the log at run time `t` s."""
        self._log(path, t, rr.TextLog(text, level=level))

    def page(self, path: str, t: float | None, markdown: str) -> None:
        """Markdown, as a document."""
        self._log(path, t, rr.TextDocument(markdown, media_type="text/markdown"))

    def _log(self, path: str, t: float | None, what: rr.AsComponents) -> None:
        if t is None:
            self._stream.log(path, what, static=True)
            return
        self._stream.set_time(TIMELINE, duration=t)
        self._stream.log(path, what)


def _rgba(colours: Sequence[int]) -> Array:
    """0xRRGGBB as rerun's 0xRRGGBBAA; an array, for a plain int is taken for one of two orders."""
    return (np.asarray(colours, dtype=np.uint32) << np.uint32(8)) | np.uint32(0xFF)


def _ascii(text: str) -> str:
    """What an application id may hold."""
    return "".join(c for c in text if c.isascii() and (c.isalnum() or c in "-_ "))[:100] or "run"


def _blueprint(layout: Layout) -> rrb.Blueprint:
    return rrb.Blueprint(
        _part(layout.root, layout.span),
        rrb.BlueprintPanel(state="hidden"),
        rrb.SelectionPanel(state="hidden"),
        rrb.TimePanel(state="collapsed", timeline=TIMELINE, play_state="following"),
        auto_views=False,
    )


def _part(part: Pane | Group, span: Span) -> Any:
    if isinstance(part, Pane):
        return _VIEWS[part.kind](part, span)
    inner = [_part(p, span) for p in part.parts]
    if part.upright:
        return rrb.Vertical(*inner, row_shares=list(part.shares))
    return rrb.Horizontal(*inner, column_shares=list(part.shares))


def _time_view(pane: Pane, span: Span) -> Any:
    start, end = _boundaries(span)
    return rrb.TimeSeriesView(
        origin=pane.path,
        name=pane.name,
        plot_legend=rrb.PlotLegend(rrb.Corner2D.LeftTop, visible=pane.legend),
        time_ranges=[rrb.VisibleTimeRange(TIMELINE, start=start, end=end)],
        axis_x=rrb.TimeAxis(view_range=rr.TimeRange(start=start, end=end)),
    )


def _boundaries(span: Span) -> tuple[Any, Any]:
    """A run that is over is seen whole; of one that goes on, the last PAST seconds."""
    boundary = rr.TimeRangeBoundary
    if span is None:
        return boundary.cursor_relative(seconds=-PAST), boundary.cursor_relative(seconds=0.0)
    return boundary.absolute(seconds=span[0]), boundary.absolute(seconds=span[1])


def _plane_view(pane: Pane, span: Span) -> Any:
    x, y = bounds()
    seen = rrb.VisualBounds2D(x_range=x, y_range=y)
    return rrb.Spatial2DView(origin=pane.path, name=pane.name, visual_bounds=seen, background=_ground())


def _space_view(pane: Pane, span: Span) -> Any:
    eye = rrb.EyeControls3D(position=EYE, look_target=LOOK, eye_up=(0.0, 0.0, 1.0))
    return rrb.Spatial3DView(
        origin=pane.path,
        name=pane.name,
        eye_controls=eye,
        line_grid=rrb.LineGrid3D(visible=False),
        background=_ground(),
    )


def _log_view(pane: Pane, span: Span) -> Any:
    columns = rrb.TextLogColumns(text_log_columns=[encodings.TextLogColumn(kind) for kind in ("LogLevel", "Body")])
    return rrb.TextLogView(origin=pane.path, name=pane.name, columns=columns)


def _ground() -> Any:
    return rrb.Background(color=_rgba([colours.GROUND]))


_VIEWS: dict[Kind, Callable[[Pane, Span], Any]] = {
    Kind.TIME: _time_view,
    Kind.PLANE: _plane_view,
    Kind.SPACE: _space_view,
    Kind.BARS: lambda pane, span: rrb.BarChartView(
        origin=pane.path, name=pane.name, plot_legend=rrb.PlotLegend(visible=False)
    ),
    Kind.LOG: _log_view,
    Kind.PAGE: lambda pane, span: rrb.TextDocumentView(origin=pane.path, name=pane.name),
}
