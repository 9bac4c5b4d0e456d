"""hdrig trend FIGURE: one figure across days and assemblies, marked where it changed by more than repeats scatter."""

from __future__ import annotations

import argparse
from pathlib import Path

from rig.catalogue.figures import WORDS
from rig.catalogue.trend import Series, Spot, Trend, trend
from rig.commands.told import tell


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig trend`."""
    parser.add_argument("figure", metavar="FIGURE", help=f"{', '.join(WORDS)}, or a name in result.json")
    parser.add_argument("root", nargs="?", type=Path, default=Path("runs"), metavar="FOLDER", help="default: runs")
    parser.add_argument("--gear", default="", metavar="SERIAL", help="serial of the gear; * and ? stand for anything")
    parser.add_argument("--json", action="store_true", help="the trend as JSON, schema hdrig.trend/1")
    parser.add_argument("--html", type=Path, metavar="FILE", help="a page of its own with the trend drawn")


def run(args: argparse.Namespace) -> int:
    """A table per gear, procedure and operating point, or JSON; and the page."""
    return tell(trend(args.root, args.figure, args.gear), args, lines, _page)


def _page(path: Path, found: Trend) -> None:
    from rig.report.comparison.trend_page import write

    write(path, found)


def lines(found: Trend) -> list[str]:
    """The trend for a terminal."""
    out: list[str] = []
    for series in found.series:
        mark = "SIMULATED " if series.simulated else ""
        out += [f"{mark}{series.title}: {series.label}", *(_line(spot, series) for spot in series.spots)]
        out += [f"  {series.sentence}", ""]
    if found.left_out:
        out.append(f"{found.left_out} more runs have the figure and do not count: not completed, or rejected")
    out += [f"note: {said}" for said in found.copies]
    out.append("intervals are 95 %; a run is marked when an unchanged gear would show as much in 1 of 100 cases")
    return out


def _line(spot: Spot, series: Series) -> str:
    from rig.report.numbers import estimate, plain

    f = spot.figure
    said = f"  {spot.row.started_utc[:16]:16s}  assembly {spot.assembly:<3d} "
    said += f"{estimate(f.value, (f.low, f.high), f.unit):28s}"
    if spot.changed:
        said += (
            f" CHANGED by {'+' if f.value > spot.level else ''}{plain(f.value - spot.level, 3)} {series.unit} from the "
            f"mean before, more than {plain(spot.limit, 2)} {series.unit}"
        )
    return f"{said}  {spot.row.path.name}"
