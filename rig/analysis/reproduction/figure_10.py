"""Fig. 10: the same for several depths of the wave generator in the flexspline."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Array
from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.claim import Claim, Number, Ruling, covers, missing, positive
from rig.analysis.reproduction.exhibit import Exhibit
from rig.analysis.reproduction.figure_9 import LEVEL, NEAR
from rig.analysis.reproduction.loads import Point, by_load, drawn, points

TITLE = "Peak to peak against load, by depth of assembly"
PAPER = (
    "The deeper the wave generator sits, the smaller the error at low load and the less it depends on the load; beyond "
    "about 7.5 N·m the curves run together."
)
SMALLER = "Deeper: smaller without load"
LESS = "Deeper: less of it goes with load"
SAME = "The same plateau at every depth"
NO_RUNS = "It takes slow runs without load and beyond 7.5 N·m at three depths or more assemblies, two depths at least."
FEWEST = 4  # assemblies: a line through fewer has no interval worth the name


@dataclass(frozen=True)
class Fitted:
    """One assembly: its depth, peak to peak without load and beyond 7.5 N·m (the largest load), arcsec."""

    depth_mm: float
    bare: float
    plateau: float


def figure(campaign: Campaign) -> Exhibit:
    """Every assembly."""
    found = points(campaign)
    each = assemblies(found)
    claims = (smaller(each), less(each), same(each))
    depths = sorted({p.depth_mm for p in found})
    if len(depths) < 2:
        return Exhibit("Figure 10", TITLE, PAPER, "", claims, missing=NO_RUNS)
    count = len({p.assembly for p in found})
    how = (
        f"{count} assemblies at {len(depths)} depths ({', '.join(f'{d:g}' for d in depths)} mm from the reference). "
        "Fitting anew changes the error too: intervals of the lines over depth are from the scatter between assemblies."
    )
    return Exhibit("Figure 10", TITLE, PAPER, how, claims, "loads", drawn(found))


def assemblies(found: Sequence[Point]) -> list[Fitted]:
    """Those with a run without load and one beyond 7.5 N·m."""
    out = []
    for number in sorted({p.assembly for p in found}):
        here = [p for p in found if p.assembly == number]
        curve = by_load(here)
        if curve[0][0] == 0.0 and curve[-1][0] >= LEVEL - NEAR:
            out.append(Fitted(here[0].depth_mm, curve[0][1].value, curve[-1][1].value))
    return out


def per_depth(depth: Array, y: Array, unit: str) -> Number | None:
    """Change of `y` from the reference to the largest depth by a straight line, interval from the scatter about it."""
    n, spread = depth.size, float(np.sum((depth - depth.mean()) ** 2)) if depth.size else 0.0
    if n < FEWEST or spread == 0.0:
        return None
    reach = float(depth.max() - depth.min())
    slope = float(np.sum((depth - depth.mean()) * y)) / spread
    rest = y - y.mean() - slope * (depth - depth.mean())
    half = t95(n - 2) * float(np.sqrt(np.sum(rest**2) / (n - 2) / spread))
    return Number.of(slope * reach, half * reach, unit)


def _columns(each: Sequence[Fitted]) -> tuple[Array, Array, Array]:
    return tuple(np.array([getattr(a, name) for a in each]) for name in ("depth_mm", "bare", "plateau"))  # type: ignore[return-value]


def _reach(depth: Array) -> str:
    return f"from {depth.min():g} to {depth.max():g} mm"


def smaller(each: Sequence[Fitted]) -> Claim:
    """Without load."""
    depth, bare, _ = _columns(each)
    change = per_depth(depth, -bare, "arcsec")
    if change is None:
        return missing(SMALLER, NO_RUNS)
    rule = f"Straight line over depth through {depth.size} assemblies: the fall is above zero with its 95 % interval."
    return Claim(SMALLER, positive(change), f"Falls by {{}} {_reach(depth)}, without load.", (change,), rule)


def less(each: Sequence[Fitted]) -> Claim:
    """Within one assembly what fitting anew does to the amplitude cancels."""
    depth, bare, plateau = _columns(each)
    change = per_depth(depth, 100.0 * plateau / np.maximum(bare, 1e-9), "% points")
    if change is None:
        return missing(LESS, NO_RUNS)
    kept = 100.0 * float(np.mean((plateau / bare)[depth == depth.min()]))
    told = (
        f"At the reference {kept:.0f} % of the error without load are left at the largest load; {{}} more "
        f"{_reach(depth)}."
    )
    rule = "Plateau over no load within each assembly, straight line over depth: it rises, with its 95 % interval."
    return Claim(LESS, positive(change), told, (change,), rule)


def same(each: Sequence[Fitted]) -> Claim:
    """No change that is told from zero, by a comparison that would have seen one as large as without load."""
    depth, bare, plateau = _columns(each)
    change, before = per_depth(depth, plateau, "arcsec"), per_depth(depth, bare, "arcsec")
    if change is None or before is None:
        return missing(SAME, NO_RUNS)
    ruling = covers(change, 0.0)
    if ruling is Ruling.HOLDS and change.half > abs(before.value):
        ruling = Ruling.OPEN
    rule = (
        "The largest load, straight line over depth: its change is not told from zero, by an interval narrower than "
        "the change without load."
    )
    told = f"The plateau changes by {{}} {_reach(depth)}; without load it is {{}}."
    return Claim(SAME, ruling, told, (change, before), rule)
