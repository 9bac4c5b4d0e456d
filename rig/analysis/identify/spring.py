"""The spring's fit from slow, lock and turning runs together, and what the torque sensor's own doubt does to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rig.analysis.identify.dynamics import LAG, Mesh, Q, Sensor, spring_columns, spring_fit
from rig.analysis.identify.gram import Known
from rig.analysis.identify.locked import locked_rows
from rig.analysis.identify.recording import Recording
from rig.analysis.identify.slow import SlowSeries, slow_rows
from rig.analysis.identify.solve import Solved
from rig.analysis.identify.windows import Projected
from rig.analysis.result import Array

PASSES = 4  # of the fit: θ̃_p enters its own damping term, δ the sensor's lag


@dataclass(frozen=True)
class SpringRuns:
    """What the spring is found from; `series` (2·terms,) rad and `J_l` are where the fit begins."""

    windows: Sequence[Projected]
    slow: Sequence[SlowSeries]
    locked: Sequence[Recording]
    terms: int
    mesh: Mesh
    J_l: float
    series: Array

    def solve(self, sensor: Sensor) -> Solved | None:
        """The fit with the torque sensor taken to read like that; None without enough rows."""
        at_K, _, at_delay, size = spring_columns(self.terms)
        c = np.zeros(size)
        c[: 2 * self.terms] = self.series
        found: Solved | None = None
        for _ in range(PASSES):
            K = 1.0 / c[at_K] if c[at_K] > 0 else 0.0
            fixed: list[Known] = [slow_rows(s, self.terms, size, K, self.J_l) for s in self.slow]
            fixed += [k for r in self.locked if (k := locked_rows(r, self.terms, size, at_K, c)) is not None]
            late = replace(sensor, lag=sensor.lag + c[at_delay])
            found = spring_fit(self.windows, fixed, self.terms, late, self.mesh, c[: 2 * self.terms])
            if found is None:
                return None
            c = found.coefficients
        return found

    def solve_doubting(self, sensor: Sensor, load: Solved | None) -> Solved | None:
        """The same, its covariance widened by what `load` leaves open of the sensor's lag and curve: both are moved by
        one standard error along their common axes, and the fit is made again.
        """
        best = self.solve(sensor)
        if best is None or load is None or not self.windows:
            return best
        covariance = best.covariance
        for shift in _axes(load.covariance[np.ix_([LAG, Q], [LAG, Q])]):
            other = self.solve(Sensor(sensor.lag + float(shift[0]), sensor.curve + float(shift[1])))
            if other is not None:
                moved = other.coefficients - best.coefficients
                covariance = covariance + np.outer(moved, moved)
        return replace(best, covariance=covariance)


def _axes(covariance: Array) -> list[Array]:
    """Vectors whose outer products add up to `covariance`; scaled first, seconds and squared seconds differ so."""
    scale = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    values, vectors = np.linalg.eigh(covariance / np.outer(scale, scale))
    return [scale * v * np.sqrt(max(float(x), 0.0)) for x, v in zip(values, vectors.T, strict=True)]
