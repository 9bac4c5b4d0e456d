"""How sure a simulated figure is: gears drawn from the gear file's uncertainty, each simulated."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from rig.core.quantiles import Z95
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear
from rig.model.gearfile import GearFile, MeasuredSeries, Parameter
from rig.model.simulate.waveform import Array, NoSteadyState

DRAWS = 60  # gears: the half width of a 95 % interval is then known to a tenth


def drawn_gears(file: GearFile, count: int = DRAWS, seed: int = 1) -> list[Gear]:
    """Gears from the intervals and covariance of `file`, parameters independent; none where it has neither."""
    generator = np.random.default_rng(seed)
    known = {name: p for name, p in file.parameters.items() if np.isfinite(p.half) and p.half > 0}
    covariance = file.kinematic_error.covariance
    sure = not np.isfinite(covariance).all()
    if not known and sure:
        return []
    gears = []
    for _ in range(count):
        numbers = dict(file.parameters)
        for name, p in known.items():
            numbers[name] = Parameter(max(p.value + p.half / Z95 * generator.standard_normal(), 1e-3 * abs(p.value)))
        series = file.kinematic_error if sure else _drawn_series(file.kinematic_error, generator)
        gears.append(replace(file, parameters=numbers, kinematic_error=series).gear())
    return gears


def _drawn_series(measured: MeasuredSeries, generator: np.random.Generator) -> MeasuredSeries:
    mean = np.array([*measured.series.a, *measured.series.b])
    c = generator.multivariate_normal(mean, measured.covariance, check_valid="ignore", method="svd").tolist()
    half = len(c) // 2
    return replace(measured, series=FourierSeries(tuple(c[:half]), tuple(c[half:])))


def half_widths(gears: list[Gear], figures: Callable[[Gear], Array]) -> Array:
    """Half widths of the 95 % intervals of `figures(gear)` (n,), from the scatter over `gears`; NaN without gears."""
    found = []
    for gear in gears:
        try:
            found.append(figures(gear))
        except NoSteadyState:  # a drawn gear that sticks, or sits on a resonance
            continue
    if len(found) < max(len(gears) // 2, 2):
        return np.full(1, np.nan) if not found else np.full_like(found[0], np.nan)
    return np.asarray(Z95 * np.std(np.array(found), axis=0, ddof=1))
