"""What lock tests and friction runs say of a gear beside the parameters of its model: what a data sheet lists."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Estimate, Result
from rig.core.units import ARCMIN
from rig.model.gearfile import Parameter

FIGURES: dict[str, tuple[str, float]] = {
    "tau_break": ("breakaway", 1.0),
    "lost_motion": ("lost_motion", ARCMIN),
    "hysteresis_loss": ("hysteresis_loss", ARCMIN),
    "hysteresis_energy": ("hysteresis_energy", 1e-3),
    "K1": ("stiffness_K1", 1.0),
    "K2": ("stiffness_K2", 1.0),
    "K3": ("stiffness_K3", 1.0),
    "T1": ("knot_T1", 1.0),
    "T2": ("knot_T2", 1.0),
}
"""Name in the gear file: name among a run's figures, and the factor from the unit shown there to SI."""


def characteristics(results: Sequence[tuple[str, Result]]) -> dict[str, Parameter]:
    """Those that any of the runs (name, result) measured, SI, over all runs that did."""
    found = {}
    for name, (figure, factor) in FIGURES.items():
        rows = [(run, e) for run, result in results for e in result.estimates if e.name == figure]
        if rows:
            found[name] = _mean([e for _, e in rows], factor, tuple(run for run, _ in rows))
    return found


def _mean(figures: Sequence[Estimate], factor: float, runs: tuple[str, ...]) -> Parameter:
    """Mean; its interval is that of one run, for runs share their sensors, and how they scatter on top."""
    values = factor * np.array([e.value for e in figures])
    halves = factor * np.array([0.5 * (e.ci95[1] - e.ci95[0]) for e in figures])
    n, value = values.size, float(values.mean())
    scatter = t95(n - 1) * float(values.std(ddof=1)) / math.sqrt(n) if n > 1 else 0.0
    half = math.hypot(float(np.sqrt(np.mean(halves**2))), scatter)
    return Parameter(value, (value - half, value + half), "measured", runs, figures[0].label)
