"""The spring's fit from slow, lock and turning runs together, and what the torque sensor's own doubt does to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.identify.dynamics import LAG, Mesh, Q, Sensor, spring_columns, spring_fit
from rig.analysis.identify.gram import Known
from rig.analysis.identify.locked import about_the_same_angle, locked_rows
from rig.analysis.identify.recording import Recording
from rig.analysis.identify.slow import SlowSeries, slow_rows
from rig.analysis.identify.solve import Solved, covariance_between
from rig.analysis.identify.windows import Projected

READING = [LAG, Q]  # of the load's fit: how the torque sensor reads
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
        shared = [about_the_same_angle(r, self.locked) for r in self.locked]
        for _ in range(PASSES):
            K = 1.0 / c[at_K] if c[at_K] > 0 else 0.0
            fixed: list[Known] = [slow_rows(s, self.terms, size, K, self.J_l) for s in self.slow]
            fixed += [
                k
                for r, alike in zip(self.locked, shared, strict=True)
                if (k := locked_rows(r, self.terms, size, at_K, c, alike)) is not None
            ]
            late = replace(sensor, lag=sensor.lag + c[at_delay])
            found = spring_fit(self.windows, fixed, self.terms, late, self.mesh, c[: 2 * self.terms])
            if found is None:
                return None
            c = found.coefficients
        return found

    def solve_doubting(self, sensor: Sensor, load: Solved | None) -> Solved | None:
        """The same, its covariance widened by what `load` leaves open of the sensor's lag and curve: both are moved by
        one standard error along their common axes, and the fit is made again. `load` was found from the same windows:
        what their noise does by way of the sensor is added to what it does directly, with its sign.
        """
        best = self.solve(sensor)
        if best is None or load is None or not self.windows:
            return best
        axes = np.array(_axes(load.covariance[np.ix_(READING, READING)]))  # rows: one standard error each
        others = [self.solve(Sensor(sensor.lag + float(a[0]), sensor.curve + float(a[1]))) for a in axes]
        moved = np.array([(best if o is None else o).coefficients for o in others])
        moved -= best.coefficients
        by_reading = np.linalg.pinv(axes) @ moved  # (2, p): of the coefficients by lag and curve
        return _with_reading(best, load, by_reading, moved.T @ moved)


def _with_reading(best: Solved, load: Solved, by_reading: Array, widening: Array) -> Solved:
    """`best` with what the sensor's reading adds to it: `widening` (p, p), and what both have in common."""
    common = covariance_between(best, load)[:, READING] @ by_reading
    indirect = {name: i[:, READING] @ by_reading for name, i in load.influence.items()}
    joined = dict(best.influence)
    for name, i in indirect.items():
        joined[name] = joined[name] + i if name in joined else i
    covariance = best.covariance + widening + common + common.T
    return replace(best, covariance=covariance, influence=joined)


def _axes(covariance: Array) -> list[Array]:
    """Vectors whose outer products add up to `covariance`; scaled first, seconds and squared seconds differ so."""
    scale = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    values, vectors = np.linalg.eigh(covariance / np.outer(scale, scale))
    return [scale * v * np.sqrt(max(float(x), 0.0)) for x, v in zip(values, vectors.T, strict=True)]
