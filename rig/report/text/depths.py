"""A sweep of assembly depths in lines: peak to peak by load, a column for every depth, with the band of one fitting."""

from __future__ import annotations

from collections.abc import Sequence

from rig.analysis.across_runs.assembly_band import Cell
from rig.report.numbers import quantity


def depth_lines(found: Sequence[Cell]) -> list[str]:
    """Peak to peak by load, a column for every depth, for people."""
    depths = sorted({c.depth_mm for c in found})
    by = {(c.depth_mm, c.load): c for c in found}
    reference = min(depths, key=abs)
    heads = ["reference" if depth == reference else f"{depth:+g} mm" for depth in depths]
    lines = ["peak to peak of the kinematic error by load and depth of assembly, arcsec, 95 % intervals"]
    lines.append("     N·m" + "".join(f"{head:>18s}" for head in heads) + "   band of one fitting, reference")
    for load in sorted({c.load for c in found}, key=abs):
        row = [by.get((depth, load)) for depth in depths]
        shown = "".join(f"{_shown(cell):>18s}" for cell in row)
        base = by.get((reference, load))
        band = "–" if base is None or base.band is None else f"{base.band.low:.2f} to {base.band.high:.2f}"
        lines.append(f"{load:8g}{shown}   {band}")
    if any(c.beyond for c in found):
        lines.append("* differs from the reference depth by more than fitting the wave generator anew does")
    return lines


def _shown(cell: Cell | None) -> str:
    if cell is None:
        return "–"
    mark = "*" if cell.beyond else ""
    half = 0.5 * (cell.peak_to_peak.high - cell.peak_to_peak.low)
    return quantity(cell.peak_to_peak.value, half) + mark
