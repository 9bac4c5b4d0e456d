"""Whether runs are of one gear, and which of them of one assembly, by what their manifests say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rig.analysis.motion.source import Source
from rig.core.errors import UsageError

FIRST = 1  # the assembly of a run that says none


def refuse_other_gears(name: str, runs: Sequence[Source]) -> None:
    """Two gears differ by more than repeats do: taken for one, what they differ by would be the floor, and the numbers
    neither's. Raises UsageError; a run that names no gear is of any."""
    serials = sorted({said for run in runs if (said := _serial(run))})
    if len(serials) > 1:
        raise UsageError(f"{name}: its runs are of {len(serials)} gears ({', '.join(serials)[:80]}), expected one")


def assembly_of(run: Source) -> tuple[Any, float]:
    """Which fitting of the wave generator, and its depth [mm]."""
    assembly, depth = run.conditions.get("assembly"), run.conditions.get("depth_mm")
    return FIRST if assembly is None else assembly, 0.0 if depth is None else depth


def _serial(run: Source) -> str:
    gear = run.manifest.get("gear")
    return str(gear.get("serial") or "") if isinstance(gear, Mapping) else ""
