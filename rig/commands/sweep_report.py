"""What stands below the summary of a sweep, and in the report of its campaign: peak to peak by load and by depth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rig.commands.load_sweep import told as law_lines
from rig.core.errors import DataError, Exit
from rig.runfile.manifest import told

if TYPE_CHECKING:
    from rig.analysis.across_runs.assembly_band import AssemblyRun, Cell
    from rig.analysis.findings.result import Result

FIGURE = "kinematic_error_peak_to_peak"
KEPT = ("gear", "backend", "declared", "encoders", "software", "started_utc", "schema")  # of the first run's manifest


def load_sweep_of(folder: Path) -> int:
    """Table and law, result.json and report.html, of the load sweep in `folder`; the exit code."""
    from rig.analysis.across_runs.load_law import LoadRun
    from rig.analysis.across_runs.sweep_result import load_sweep

    runs = runs_of(folder)
    ways = [LoadRun(r.load, r.peak_to_peak.value, down) for r, down in runs]
    return finish(folder, load_sweep([r for r, _ in runs], ways) if runs else None, law_lines(ways))


def assembly_sweep_of(folder: Path) -> int:
    """Table by depth with the reproducibility band, result.json and report.html; the exit code."""
    from rig.analysis.across_runs.assembly_band import cells, repeat
    from rig.analysis.across_runs.sweep_result import assembly_sweep

    runs = [run for run, _ in runs_of(folder)]
    lines = depth_lines(cells(runs, repeat(runs))) if runs else []
    return finish(folder, assembly_sweep(runs) if runs else None, lines)


def runs_of(folder: Path) -> list[tuple[AssemblyRun, bool]]:
    """Every completed slow run of the campaign in `folder` whose peak to peak counts, and whether on the sweep's way
    down."""
    from rig.analysis.across_runs.assembly_band import AssemblyRun
    from rig.analysis.findings.intervals import Ranged
    from rig.catalogue.figures import figures
    from rig.runfile.manifest import read

    found = []
    for path in sorted(folder.glob("*/result.json")):
        manifest, figure = read(path.parent), figures(path.parent).get(FIGURE)
        if (
            figure is None
            or figure.rejected
            or manifest.get("status") != "completed"
            or manifest.get("procedure") != "kinematic_error"
        ):
            continue
        about = manifest.get("conditions") or {}
        load, depth = float(about.get("tau_ext") or 0.0), float(about.get("depth_mm") or 0.0)
        size = Ranged(figure.value, figure.low, figure.high)
        found.append((AssemblyRun(load, depth, int(about.get("assembly") or 1), size), _down(manifest)))
    return found


def _down(manifest: Mapping[str, Any]) -> bool:
    """Whether the run is of a sweep's way down; runs of before the manifest said so have it in their note."""
    way = (manifest.get("campaign") or {}).get("way")
    return way == "down" if way else str((manifest.get("conditions") or {}).get("note") or "").endswith("down")


def finish(folder: Path, result: Result | None, lines: Sequence[str]) -> int:
    """`lines` at the end of the summary, result and report beside it, both on stdout. Raises DataError."""
    from rig.commands.analyse import exit_of, print_result
    from rig.report.page import write
    from rig.report.record import write_result

    if result is None:
        print("no run of the sweep was analysed: there is nothing to compare")
        return int(Exit.INCOMPLETE)
    about = manifest_of(folder, result)
    with told(DataError, f"the runs are complete, their summary cannot be written into {folder}"):
        with (folder / "summary.txt").open("a", encoding="utf-8") as summary:
            summary.write("\n" + "\n".join(lines) + "\n")
        write_result(folder, result)
        write(folder, about, {}, [], result)
    print("\n".join(lines))
    print_result(result, folder, folder, about.get("backend") == "sim")
    return int(exit_of(result))


def manifest_of(folder: Path, result: Result) -> dict[str, Any]:
    """What the page says of the campaign: gear, origin and software of its first run, all its loads and depths."""
    from rig.runfile.manifest import read

    first: Mapping[str, Any] = read(next(path.parent for path in sorted(folder.glob("*/result.json"))))
    rows = [row for rows in result.tables.values() for row in rows]
    loads = sorted({float(row["load_nm"]) for row in rows}, key=abs)
    depths = sorted({float(row["depth_mm"]) for row in rows})
    conditions = {
        "loads": ", ".join(f"{x:g}" for x in loads) + " N·m",
        "depths": ", ".join(f"{x:+g}" if x else "0" for x in depths) + " mm from the reference",
    }
    kept = {key: first[key] for key in KEPT if key in first}
    uid = first.get("campaign", {}).get("uid")
    return {
        **kept,
        **({"uid": uid} if uid else {}),
        "procedure": result.procedure,
        "status": "completed",
        "conditions": conditions,
    }


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
    from rig.report.numbers import quantity

    if cell is None:
        return "–"
    mark = "*" if cell.beyond else ""
    half = 0.5 * (cell.peak_to_peak.high - cell.peak_to_peak.low)
    return quantity(cell.peak_to_peak.value, half) + mark
