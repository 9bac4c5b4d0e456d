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
LITTLE = 5.0  # times the narrowest interval: a run with a wider one knows next to nothing beside it
ALIKE = 0.1  # relative, of the torques that a figure is over


def characteristics(results: Sequence[tuple[str, Result]]) -> dict[str, Parameter]:
    """Those that any of the runs (name, result) measured, SI, over all runs that know it about as well; of a figure
    over a part of the torques over those that have it over the same part as the run that knows it best."""
    found = {}
    for name, (figure, factor) in FIGURES.items():
        rows = [(run, e) for run, result in results for e in result.estimates if e.name == figure]
        if rows:
            best = min((e for _, e in rows), key=_half)
            rows = [(run, e) for run, e in rows if _knows(e, best) and _over_the_same(e, best)]
            found[name] = _mean([e for _, e in rows], factor, tuple(run for run, _ in rows))
    return found


def _half(figure: Estimate) -> float:
    """Of its interval; boundless where there is none."""
    half = 0.5 * (figure.ci95[1] - figure.ci95[0])
    return half if math.isfinite(half) else math.inf


def _knows(one: Estimate, best: Estimate) -> bool:
    """Whether a figure is known about as well as the one that is known `best`."""
    return _half(one) <= LITTLE * _half(best)


def _over_the_same(one: Estimate, other: Estimate) -> bool:
    if one.over is None or other.over is None:
        return True
    return bool(np.allclose(one.over, other.over, rtol=ALIKE))


def _mean(figures: Sequence[Estimate], factor: float, runs: tuple[str, ...]) -> Parameter:
    """Mean; its interval is that of one run, for runs share their sensors, and how they scatter on top."""
    values = factor * np.array([e.value for e in figures])
    halves = factor * np.array([_half(e) for e in figures])
    n, value = values.size, float(values.mean())
    scatter = t95(n - 1) * float(values.std(ddof=1)) / math.sqrt(n) if n > 1 else 0.0
    half = math.hypot(float(np.sqrt(np.mean(halves**2))), scatter)
    return Parameter(value, (value - half, value + half), "measured", runs, figures[0].label)
