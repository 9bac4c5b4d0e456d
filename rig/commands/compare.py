"""hdrig compare RUN RUN…: figures side by side, and which of them changed by more than repeats scatter."""

from __future__ import annotations

import argparse
from pathlib import Path

from rig.catalogue.compare import Comparison, Difference, Line, Mark, compare
from rig.catalogue.figures import Figure
from rig.catalogue.row import Row
from rig.catalogue.sameness import point, words
from rig.commands.told import tell

SHOWN = {
    Mark.CHANGED: "CHANGED, more than reproducibility ({limit})",
    Mark.WITHIN: "within reproducibility ({limit})",
    Mark.UNKNOWN: "reproducibility not known",
    Mark.NONE: "",
}


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig compare`."""
    parser.add_argument("runs", nargs="+", type=Path, metavar="RUN", help="run folders; the others against the first")
    parser.add_argument(
        "--among",
        type=Path,
        metavar="FOLDER",
        help="where repeats are looked for; default: where the runs lie",
    )
    parser.add_argument("--json", action="store_true", help="the comparison as JSON, schema hdrig.comparison/1")
    parser.add_argument(
        "--html", type=Path, metavar="FILE", help="a page of its own with the waveforms over one another as well"
    )


def run(args: argparse.Namespace) -> int:
    """Tables on stdout, or JSON; and the page."""
    return tell(compare(args.runs, args.among), args, lines, _page)


def _page(path: Path, found: Comparison) -> None:
    from rig.report.comparison.page import write

    write(path, found)


def lines(found: Comparison) -> list[str]:
    """The comparison for a terminal."""
    out = [f"{k + 1}  {named(row)}" for k, row in enumerate(found.rows)]
    out += [f"note: {remark}" for remark in found.remarks]
    for line in found.lines:
        out += ["", line.label, *_of_runs(line)]
    return [*out, "", *_how(found)]


def named(row: Row) -> str:
    """A run in one line."""
    mark = "SIMULATED " if row.simulated else ""
    gear, when = row.gear or "not stated", row.started_utc[:16] or "not dated"
    return f"{mark}{row.path.name}  {words(point(row))}, gear {gear}, {when}"


def _of_runs(line: Line) -> list[str]:
    rows = []
    for k, (value, difference) in enumerate(zip(line.values, line.differences, strict=True)):
        rows.append(f"  {k + 1}  {shown(value):28s} {changed(difference, line.unit)}".rstrip())
    return rows


def shown(value: Figure | None) -> str:
    """A figure with its interval."""
    from rig.report.numbers import estimate

    if value is None:
        return "not in this run"
    return estimate(value.value, (value.low, value.high), value.unit) + (" (rejected run)" if value.rejected else "")


def changed(d: Difference | None, unit: str) -> str:
    """A difference, its interval, and what it amounts to."""
    from rig.report.numbers import estimate, plain

    if d is None:
        return ""
    if d.value == 0:
        return "no difference"
    said = estimate(d.value, (d.low, d.high), unit)
    sign = "+" if d.value > 0 and not said.startswith("<") else ""
    limit = f"{plain(d.limit, 2)} {unit}" if unit != "1" else plain(d.limit, 2)
    return f"{sign}{said}  {SHOWN[d.mark].format(limit=limit)}".rstrip()


def _how(found: Comparison) -> list[str]:
    """The estimate of reproducibility behind the first figure, which all of one point share but for its number."""
    first = next((d for line in found.lines for d in line.differences if d is not None), None)
    if first is None:
        return ["no differences: a run was rejected, or its figures are in other units"]
    return [
        "differences are to run 1, with 95 % intervals; two unchanged runs stay within reproducibility 99 times of 100",
        f"{found.lines[0].label}: {first.how}",
    ]
