"""What an effect is: where it acts on the rig, and the columns it adds to the equations there.

One definition serves the search for effects in measured runs, the refit, the simulation and the report.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from enum import StrEnum
from functools import cached_property
from types import MappingProxyType
from typing import Any, ClassVar, Final

import numpy as np
import numpy.typing as npt

from rig.core.once import Once
from rig.core.quantiles import Z95
from rig.model.fourier import FourierSeries
from rig.model.gloss import gloss

Array = npt.NDArray[np.float64]
Rows = npt.NDArray[np.int64]
Shape = tuple[float, ...]
"""The parameters an effect depends on nonlinearly (a Stribeck speed, an order), in `shape_names`' order."""


ALIKE: Final = 1e-9  # relative: what rounding leaves of two speeds of which one was made from the other
MEASURED: Final = frozenset({"t", "theta_m", "theta_l", "tau_m", "tau_l"})
"""What a full campaign measures."""


class Port(StrEnum):
    """Where an effect enters      [ghorbel2001, Eqs. 6-7]

    With θ̃ = θ_m/N − θ_l, the shaft torque T (what the gear gives to the load) and the reading r of a sensor:

    MOTOR_TORQUE     N·m that resists the motor, as B_m·ω_m does
    LOAD_TORQUE      N·m that resists the load, as B_l·ω_l does
    KINEMATIC_ERROR  rad that adds to θ̃_p
    LEVER            dθ̃_p/dθ_m of the same columns; without it the columns turn no torque
    WIND_UP          rad of θ̃ that goes with the torque, as T/K does
    READS_*          what the reading of that sensor has too much, in its own unit
    """

    MOTOR_TORQUE = "motor_torque"
    LOAD_TORQUE = "load_torque"
    KINEMATIC_ERROR = "kinematic_error"
    LEVER = "lever"
    WIND_UP = "wind_up"
    READS_THETA_M = "reads_theta_m"
    READS_THETA_L = "reads_theta_l"
    READS_TAU_M = "reads_tau_m"
    READS_TAU_L = "reads_tau_l"


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
    jerk_l: Array
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

    def states(self, make: Callable[[Signals], tuple[Array, ...]]) -> tuple[Array, ...]:
        """What `make` gives of the whole piece, in these rows (n,): a state remembers what was before the first."""
        return make(self) if self.cut is None else tuple(self.cut.of(x) for x in make(self.cut.whole))

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


@dataclass(frozen=True)
class Known:
    """The baseline as fitted so far: what columns may lean on. SI."""

    K: float
    B_sp: float
    J_m: float
    J_l: float
    kinematic_error: FourierSeries
    tau_c: float = 0.0  # N·m and N·m·s/rad, the motor's friction
    B_m: float = 0.0
    torque_zero: float = 0.0  # N·m, what the torque sensor reads without torque; `torque` is without it


@dataclass(frozen=True)
class Reach:
    """What a campaign covers, from which an effect chooses the shapes worth trying. SI."""

    ratio: float
    fastest: float  # rad/s of the motor
    slowest: float  # rad/s of the motor, while it turns
    torque: float  # N·m, largest |T|
    duration: float  # s, first to last sample of the campaign
    rate: float  # Hz of the samples
    band: float  # Hz up to which the equations are compared
    load_turns: float  # most output turns in one run
    counts_m: float  # encoder counts per turn; 0 when not said
    counts_l: float
    has: frozenset[str] = MEASURED  # channels that any run measured
    lines_m: tuple[int, ...] = ()  # line counts that the residual shows, whatever is said of the encoders
    lines_l: tuple[int, ...] = ()


@dataclass(frozen=True)
class Fit:
    """What the data say of one effect: coefficients (k,), then shape (s,); covariance (k+s, k+s) of both together."""

    coefficients: Array
    shape: Shape
    covariance: Array
    known: Known
    ratio: float

    def half_width(self, gradient: Array) -> float:
        """Half the 95 % interval of a figure whose gradient by (coefficients, shape) is `gradient` (k+s,)."""
        return float(Z95 * np.sqrt(max(0.0, float(gradient @ self.covariance @ gradient))))


@dataclass(frozen=True)
class Parameter:
    """A figure of an effect in the words of the field."""

    name: str
    value: float
    ci95: tuple[float, float]
    unit: str

    @property
    def holds_zero(self) -> bool:
        """Whether its interval does."""
        return self.ci95[0] <= 0 <= self.ci95[1]


def parameter(name: str, value: float, half: float, unit: str) -> Parameter:
    """A parameter with a symmetric interval."""
    return Parameter(name, float(value), (float(value - half), float(value + half)), unit)


def harmonic(fit: Fit, name: str, unit: str, first: int = 0, scale: float = 1.0) -> tuple[Parameter, Parameter]:
    """c·cos x + s·sin x = A·cos(x + phase) from coefficients `first` and `first + 1`: amplitude A and phase."""
    c, s = fit.coefficients[first] * scale, fit.coefficients[first + 1] * scale
    size = float(np.hypot(c, s)) or 1e-300
    along, around = np.zeros(fit.covariance.shape[0]), np.zeros(fit.covariance.shape[0])
    along[first : first + 2] = np.array([c, s]) / size * scale
    around[first : first + 2] = np.array([s, -c]) / size**2 * scale
    return (
        parameter(f"{name}_amplitude", size, fit.half_width(along), unit),
        parameter(f"{name}_phase", float(np.arctan2(-s, c)), fit.half_width(around), "rad"),
    )


class Effect(ABC):
    """One physical effect the paper's model lacks. Members are stateless; the catalogue holds one of each."""

    name: ClassVar[str]  # also the file's name
    in_short: ClassVar[str]  # one line for people
    glosses: ClassVar[Mapping[str, str]] = {}  # what its parameters are, by name; see rig/model/gloss.py
    source: ClassVar[str]  # key in rig/model/references.py, with the equation where there is one
    shape_names: ClassVar[tuple[str, ...]] = ()
    adds: ClassVar[frozenset[str]] = frozenset()  # parameters of which several terms of it make one sum
    remembers: ClassVar[bool] = False  # its state when a run begins is unknown: beside it every run has its own zero
    backbone: ClassVar[bool] = False  # a loop in torque against wind-up has a mean curve that looks like it
    needs: ClassVar[frozenset[str]] = frozenset()  # channels without which it cannot be told from the baseline
    each_run: ClassVar[bool] = False  # every run has coefficients of its own: a phase, an instant
    modes_apart: ClassVar[float] = np.inf  # of its first loose shape parameter: so much higher, a term is another mode
    loose: ClassVar[tuple[bool, ...]] = ()  # which shape parameters a refit may move; the others are chosen, not fitted
    usual: ClassVar[Mapping[str, tuple[float, ...]]] = MappingProxyType({})  # shape of textbook laws, by name

    @abstractmethod
    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """The shapes worth trying on such a campaign; `((),)` when the effect has none; () when it cannot show."""

    @abstractmethod
    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Columns (n, k) at each port the effect acts on, one set of k coefficients for all of them."""

    @abstractmethod
    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """The coefficients in the words of the field."""

    def gloss(self, name: str) -> str:
        """What its parameter of that name is, a short phrase; "" where nothing is said of it."""
        return gloss(self.glosses, name)

    def plausible(self, fit: Fit) -> bool:
        """False when the coefficients have a sign or size no such effect can have."""
        return True

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """Range of each shape parameter in a refit."""
        grid = np.array(self.shapes(reach), dtype=float)
        if grid.size == 0:
            return ()
        return tuple((float(low), float(high)) for low, high in zip(grid.min(0) / 3, grid.max(0) * 3, strict=True))

    def has_state(self) -> bool:
        """Whether what it does at a row depends on more than that row and its neighbours: then its columns in a part of
        a piece have to be cut from those of the whole. Not of one that asks for `Signals.states`."""
        return False

    def moved_by_noise(self) -> bool:
        """True when noise of a reading moves a state of its own, and does not add to its columns."""
        return False

    def is_scaled(self, scale: Parameter, reach: Reach) -> bool:
        """Whether the number that scales the law (a speed, a torque, a time), with its interval, says anything of it;
        else what it explains is a difference between some runs and others, which many laws make."""
        return not scale.holds_zero

    def beyond(self, shape: Shape, reach: Reach) -> bool:
        """True when a fit ended where the campaign shows nothing of the law itself, a resonance above its band."""
        return False

    def unloaded(self, order: int, known: Known, shape: Shape) -> Array:
        """Cosine and sine of an order of θ̃_p that each coefficient adds to the baseline's without load, (2, k) or, of
        one that adds none, (2, 0)."""
        return np.zeros((2, 0))

    def expands(self, shape: Shape) -> bool:
        """True when the columns are an expansion about a shape that should equal the coefficients."""
        return False

    def about(self, shape: Shape, coefficients: Array) -> Shape:
        """The shape to expand about, once the coefficients are known."""
        return shape
