"""What an effect sees of a run: its signals on a uniform time grid, whole or in part."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from rig.core.once import Once
from rig.model.effect.known import Known

Array = npt.NDArray[np.float64]
Rows = npt.NDArray[np.int64]

COLD: Final = 7200.0  # s of rest after which a drive is cold again: of a warm-up of 40 min a twentieth is left
ALIKE: Final = 1e-9  # relative: what rounding leaves of two speeds of which one was made from the other


@dataclass(frozen=True)
class Moved:
    """How one run moved the motor: from `start` to `end` s of the campaign, mean |ω_m| rad/s and mean ω_m²."""

    start: float
    end: float
    speed: float
    square: float


@dataclass(frozen=True)
class Signals(Once):
    """A piece of one run on a uniform time grid, shapes (n,), SI, and what is known of the gear so far. What an effect
    makes of it whatever its shape is made `once`: a refit asks for the columns of dozens of shapes.

    Angles are as read; speeds, accelerations and the torque are low-passed without phase. A channel that was not
    recorded is NaN throughout. `way` is the direction of the motor, −1, 0 (sticking or reversing) or 1.
    """

    t: Array  # s since the campaign began
    dt: float  # s
    ratio: float
    theta_m: Array
    theta_l: Array
    omega_m: Array
    alpha_m: Array
    omega_l: Array
    alpha_l: Array
    torque: Array  # N·m, T
    torque_rate: Array
    tau_m: Array
    tau_l: Array  # N·m, as read: `torque` before the low-pass
    tau_ext: Array
    way: Array
    temperature: Array  # °C
    gear: Known
    thinned: int = 1  # readings that made one row
    past: tuple[Moved, ...] = ()  # of the whole campaign
    cut: Cut | None = None  # what it is a part of: a state remembers what was before
    stiffness: Array | None = None  # N·m/rad, of a lock test whose torque nobody read: what more wind-up takes more
    carried: Array | None = None  # N·m, of a `tau_l` that nobody read: what effects found in the load take

    def kept(self, order: float, omega: Array) -> Array:
        """Share (n,) of a wave of `order` periods per turn at `omega` rad/s that is left in the rows: brought down from
        a higher rate, they have lost what is faster than a third to two thirds of their own. Before that the readings
        themselves folded it over.
        """
        if self.thinned == 1:
            return np.ones(omega.size)
        from rig.model.waves import left_of  # compiled: not for those who only read a gear file

        return np.asarray(left_of(order, omega, self.dt, self.thinned / self.dt))

    def heat(self, t_w: float) -> Array:
        """What the motor's friction has turned into heat since the campaign began, leaking with `t_w` s: J, (n,)."""
        out = np.zeros(self.t.size)
        first, last = (float(self.t[0]), float(self.t[-1])) if self.t.size else (0.0, 0.0)
        cooled = np.exp((first - self.t) / t_w)
        for run in self.past:
            power = self.gear.tau_c * run.speed + self.gear.B_m * run.square
            if run.end <= first:  # most have: what is left of their heat cools alike
                out += power * t_w * (math.exp((run.end - first) / t_w) - math.exp((run.start - first) / t_w)) * cooled
            elif run.start < last:
                since, until = np.maximum(self.t - run.start, 0.0), np.maximum(self.t - run.end, 0.0)
                out += power * t_w * (np.exp(-until / t_w) - np.exp(-since / t_w))
        return out

    @cached_property
    def in_use(self) -> Array:
        """s since the drive was last cold, (n,): since the campaign began, or the first run after a long rest."""
        began, still = 0.0, -math.inf
        for run in sorted(self.past, key=lambda run: run.start):
            if self.t.size and run.start > self.t[0]:
                break
            if run.start - still > COLD and still > -math.inf:
                began = run.start
            still = max(still, run.end)
        return np.maximum(self.t - began, 0.0)

    @cached_property
    def _series(self) -> tuple[Array, ...]:
        """θ̃_p along the run, as far as it is known, and its first two derivatives by θ_m, (n,) each."""
        from rig.model.waves import sums  # compiled: not for those who only read a gear file

        return sums(self.gear.kinematic_error, self.theta_m, 0, 1, 2)

    @property
    def series_slope(self) -> Array:
        """dθ̃_p/dθ_m along the run, as far as it is known, (n,)."""
        return self._series[1]

    @property
    def series_bend(self) -> Array:
        """d²θ̃_p/dθ_m² along the run, as far as it is known, (n,)."""
        return self._series[2]

    @property
    def lever(self) -> Array:
        """1/N − θ̃_p′ along the run, (n,): by how much T acts on the motor, and what the output turns with it."""
        return np.asarray(1.0 / self.ratio - self.series_slope)

    @property
    def series_value(self) -> Array:
        """θ̃_p along the run, as far as it is known, (n,)."""
        return self._series[0]

    @cached_property
    def spring_torque(self) -> Array:
        """T − B_sp·φ̇: what the spring holds of the shaft torque while the damper beside it takes the rest, N·m, (n,).
        Where one angle stands in for the other the torque itself has to tell how fast the spring winds up."""
        wound = self.omega_m / self.ratio - self.omega_l
        if np.max(np.abs(wound), initial=0.0) > ALIKE * np.max(np.abs(self.omega_l), initial=0.0):
            return self.torque - self.gear.B_sp * (wound - self.series_slope * self.omega_m)
        return self.torque - self.gear.B_sp / self.gear.K * self.torque_rate

    def states(self, make: Callable[[Signals], tuple[Array, ...]], *by: float) -> tuple[Array, ...]:
        """What `make` gives of the whole piece `by` these numbers, in its rows (n,): a state remembers what was before
        the first. Of the parts of one whole the first that asks has it made."""
        if self.cut is None:
            return make(self)
        whole = self.cut.whole
        return tuple(self.cut.of(x) for x in whole.lately(make.__qualname__, by, lambda: make(whole)))

    def part(self, rows: slice | Rows) -> Signals:
        """Some rows of it: a slice, or their numbers (m,) in rising order, stretches side by side."""
        arrays: dict[str, Any] = {
            f.name: v[rows] for f in fields(self) if isinstance(v := getattr(self, f.name), np.ndarray)
        }
        cut = Cut(self, range(self.t.size)) if self.cut is None else self.cut
        return replace(self, **arrays, cut=cut.part(rows))


@dataclass(frozen=True)
class Cut:
    """Where a part of a piece was taken from: `rows` of `whole`."""

    whole: Signals
    rows: range | Rows

    def of(self, x: Array) -> Array:
        """Those rows of `x` (n, ...)."""
        return x[self.rows.start : self.rows.stop] if isinstance(self.rows, range) else x[self.rows]

    def part(self, rows: slice | Rows) -> Cut:
        """Some of those rows."""
        if isinstance(rows, slice):
            return Cut(self.whole, self.rows[rows])
        return Cut(self.whole, self.rows.start + rows if isinstance(self.rows, range) else self.rows[rows])

    def again(self, whole: Signals) -> Signals:
        """The same rows of another one."""
        return whole.part(slice(self.rows.start, self.rows.stop) if isinstance(self.rows, range) else self.rows)
