"""A campaign of loads or depths as one result: peak to peak of its slow runs, kept as summary, result and report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rig.core.errors import DataError
from rig.runfile.manifest import told
from rig.runfile.origin import SIM

if TYPE_CHECKING:
    from rig.analysis.across_runs.assembly_band import AssemblyRun
    from rig.analysis.findings.result import Result

FIGURE = "kinematic_error_peak_to_peak"
KEPT = ("gear", "backend", "declared", "encoders", "software", "started_utc", "schema")  # of the first run's manifest


@dataclass(frozen=True)
class Sweep:
    """What the runs of a sweep say together."""

    result: Result
    lines: Sequence[str]  # the table of it, for people
    simulated: bool


def load_sweep_of(folder: Path) -> Sweep | None:
    """The load sweep in `folder`, kept there; None when no run of it was analysed. Raises DataError."""
    from rig.analysis.across_runs.load_law import LoadRun
    from rig.analysis.across_runs.sweep_result import load_sweep
    from rig.report.text.load_law import told as law_lines

    runs = runs_of(folder)
    if not runs:
        return None
    ways = [LoadRun(r.load, r.peak_to_peak.value, down) for r, down in runs]
    return _kept(folder, load_sweep([r for r, _ in runs], ways), law_lines(ways))


def assembly_sweep_of(folder: Path) -> Sweep | None:
    """The sweep of depths in `folder`, with its reproducibility band, kept there; None when no run of it was analysed.
    Raises DataError."""
    from rig.analysis.across_runs.assembly_band import cells, repeat
    from rig.analysis.across_runs.sweep_result import assembly_sweep
    from rig.report.text.depths import depth_lines

    runs = [run for run, _ in runs_of(folder)]
    return _kept(folder, assembly_sweep(runs), depth_lines(cells(runs, repeat(runs)))) if runs else None


def runs_of(folder: Path) -> list[tuple[AssemblyRun, bool]]:
    """Every completed slow run of the campaign in `folder` whose peak to peak counts, and whether on the sweep's way
    down."""
    from rig.analysis.across_runs.assembly_band import AssemblyRun
    from rig.analysis.findings.intervals import Ranged
    from rig.catalogue.figures import figures
    from rig.core.numbers import number
    from rig.runfile.manifest import read
    from rig.runfile.misfits import usable

    found = []
    for path in sorted(folder.glob("*/result.json")):
        manifest, figure = usable(read(path.parent)), figures(path.parent).get(FIGURE)
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
        found.append((AssemblyRun(load, depth, int(number(about.get("assembly"), 1.0)), size), _down(manifest)))
    return found


def _down(manifest: Mapping[str, Any]) -> bool:
    """Whether the run is of a sweep's way down; runs of before the manifest said so have it in their note."""
    way = (manifest.get("campaign") or {}).get("way")
    return way == "down" if way else str((manifest.get("conditions") or {}).get("note") or "").endswith("down")


def _kept(folder: Path, result: Result, lines: Sequence[str]) -> Sweep:
    """`lines` at the end of the summary, result and report beside it. Raises DataError."""
    from rig.report.page import write
    from rig.report.record import write_result

    about = manifest_of(folder, result)
    with told(DataError, f"the runs are complete, their summary cannot be written into {folder}"):
        with (folder / "summary.txt").open("a", encoding="utf-8") as summary:
            summary.write("\n" + "\n".join(lines) + "\n")
        write_result(folder, result)
        write(folder, about, {}, [], result)
    return Sweep(result, lines, about.get("backend") == SIM)


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
