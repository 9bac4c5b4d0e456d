"""What fitting the wave generator anew does by itself, and what its depth does beyond that."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtri

from rig.analysis.findings.intervals import Ranged, t95


@dataclass(frozen=True)
class AssemblyRun:
    """One slow run of one assembly: load N·m, depth mm from the reference, peak to peak arcsec with its interval."""

    load: float
    depth_mm: float
    assembly: int
    peak_to_peak: Ranged


@dataclass(frozen=True)
class Repeat:
    """1 σ of the peak to peak from fitting to fitting at one depth, relative; `dof` degrees of freedom behind it."""

    sigma: float
    dof: int

    @property
    def interval(self) -> tuple[float, float]:
        """95 % of `sigma`: χ² of as many degrees of freedom."""
        low, high = (self.sigma * np.sqrt(self.dof / chdtri(self.dof, p)) for p in (0.025, 0.975))
        return float(low), float(high)


@dataclass(frozen=True)
class Cell:
    """One depth under one load: mean over its assemblies, arcsec."""

    depth_mm: float
    load: float
    assemblies: int
    peak_to_peak: Ranged
    change: Ranged | None  # against the reference depth; None there
    band: Ranged | None  # where 95 of 100 single fittings at the reference depth lie; None without re-assemblies

    @property
    def beyond(self) -> bool:
        """Whether the depth makes a difference that fitting anew does not."""
        return self.change is not None and not self.change.low <= 0.0 <= self.change.high


def repeat(runs: Sequence[AssemblyRun]) -> Repeat | None:
    """From depths that were fitted more than once. None where none was.

    An assembly that is off is off by the same share under every load: its loads count as one, not as many.
    """
    squares, dof = 0.0, 0
    for depth in sorted({r.depth_mm for r in runs}):
        numbers = sorted({r.assembly for r in runs if r.depth_mm == depth})
        if len(numbers) < 2:
            continue
        off = [_shares(runs, depth, number) for number in numbers]
        loads = set.intersection(*(set(o) for o in off))
        if not loads:
            continue
        table = np.array([[o[load] for load in sorted(loads)] for o in off])
        relative = table / table.mean(axis=0) - 1.0
        squares += float(np.sum(np.mean(relative**2, axis=1)))
        dof += len(numbers) - 1
    return Repeat(float(np.sqrt(squares / dof)), dof) if dof else None


def _shares(runs: Sequence[AssemblyRun], depth: float, number: int) -> dict[float, float]:
    """Peak to peak by load of one assembly; runs of one load together."""
    here = [r for r in runs if r.depth_mm == depth and r.assembly == number]
    return {
        load: float(np.mean([r.peak_to_peak.value for r in here if r.load == load])) for load in {r.load for r in here}
    }


def cells(runs: Sequence[AssemblyRun], found: Repeat | None) -> list[Cell]:
    """Every depth under every load it was run with, by depth, then load; the reference is the depth nearest to 0."""
    depths = sorted({r.depth_mm for r in runs})
    reference = min(depths, key=abs)
    return [
        _cell(runs, depth, load, reference, found)
        for depth in depths
        for load in sorted({r.load for r in runs if r.depth_mm == depth}, key=abs)
    ]


def _cell(runs: Sequence[AssemblyRun], depth: float, load: float, reference: float, found: Repeat | None) -> Cell:
    value, own, n = _mean(runs, depth, load)
    shown = _ranged(value, _half(found, value, 1.0 / n, own))
    if not any(r.depth_mm == reference and r.load == load for r in runs):
        return Cell(depth, load, n, shown, None, None)
    base, base_own, m = _mean(runs, reference, load)
    both = float(np.hypot(own, base_own))
    change = None if depth == reference else _ranged(value - base, _half(found, base, 1.0 / n + 1.0 / m, both))
    band = None if found is None else _ranged(base, _half(found, base, 1.0 + 1.0 / m, base_own))
    return Cell(depth, load, n, shown, change, band)


def _mean(runs: Sequence[AssemblyRun], depth: float, load: float) -> tuple[float, float, int]:
    """(mean, half width of its interval by the runs' own, assemblies)."""
    here = [r for r in runs if r.depth_mm == depth and r.load == load]
    halves = np.array([0.5 * (r.peak_to_peak.high - r.peak_to_peak.low) for r in here])
    own = float(np.sqrt(np.sum(halves**2))) / len(here)
    return float(np.mean([r.peak_to_peak.value for r in here])), own, len({r.assembly for r in here})


def _half(found: Repeat | None, value: float, share: float, own: float) -> float:
    """Half width: scatter of fittings where it is known, which holds that of the runs; never less than theirs."""
    return own if found is None else max(t95(found.dof) * found.sigma * abs(value) * float(np.sqrt(share)), own)


def _ranged(value: float, half: float) -> Ranged:
    return Ranged(value, value - half, value + half)
