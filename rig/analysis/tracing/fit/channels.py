"""The three equations of the rig as linear regressions, and how an effect's ports show in them.

With θ̃ = θ_m/N − θ_l, the shaft torque T and the paper's θ̃_p      [ghorbel2001, Eqs. 1, 6-8]

    A (rad)  θ̃ = c_0 + θ̃_p(θ_m) + T/K − (B_sp/K²)·Ṫ + (B_sp²/K³)·T̈ + (B_ml/K)·ω_m
    M (N·m)  τ_m − T/N = τ_0 − T·θ̃_p′(θ_m) + J_m·ω̇_m + B_m·ω_m + τ_c·sgn ω_m
    R        M where the motor has just turned back, or soon will: friction that builds up over milliradians
    L (N·m)  T + τ_ext = J_l·ω̇_l + B_l·ω_l + τ_cl·sgn ω_l + z

T = r + δ·ṙ of the reading r: every torque sensor has a low-pass of its own, 0.16 ms for one of 1 kHz, and at 500 rpm a
tenth of a millisecond stands above the noise of L. The torque sensor's zero z wanders from run to run, and c_0 may: how
far is read from repeats. B_ml shows in
A only when the torque sensor sits behind the mesh's own drag; it is known to be small.

A sensor that is not there takes one equation away, and what it would have said is put into the others:

no torque sensor   T = J_l·ω̇_l − τ_ext from L with the inertia declared, and what else L says stands in A and M
no load angle      θ_l = θ_m/N − θ̃ from A, in L: J_l·(ω̇_m/N − d²θ̃/dt²)
no motor angle     θ_m = N·(θ_l + θ̃) from A, in M: J_m·N·(ω̇_l + d²θ̃/dt²)
no time            rows have no known distance: whatever is a rate belongs to each run alone
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.runs.counts import FREE, LOCKED, one_a_stay, resting
from rig.analysis.tracing.runs.first_stroke import has_turned
from rig.analysis.tracing.runs.recording import COARSE, UNKNOWN, Recording, settled
from rig.analysis.tracing.runs.smoothing import Smoother
from rig.model.effect import Array, Known, Port, Signals
from rig.model.fourier import FourierSeries
from rig.model.waves import powers

ORDERS: Final = 15  # terms of θ̃_p      [ghorbel2001, Eq. 8]
CHANNELS: Final = ("A", "M", "R", "L")
WHOLE: Final = ("A", "M", "L")
"""Those that hold all along a run; R is M where the motor has just turned back."""
SERIES: Final = tuple(f"{c}{n}" for n in range(1, ORDERS + 1) for c in "ab")
BASELINE: Final = (
    *SERIES,
    "compliance",
    "damping",
    "damping_2",
    "mesh",
    "c_0",
    "J_m",
    "B_m",
    "tau_c",
    "tau_0",
    "J_l",
    "B_l",
    "tau_cl",
    "tau_l0",
    "lag",
)
INDEX: Final = {name: i for i, name in enumerate(BASELINE)}
RATES: Final = frozenset({"damping", "damping_2", "mesh", "J_m", "B_m", "J_l", "B_l", "lag"})
"""Coefficients of derivatives by time."""
HIGHEST: Final = 3  # derivative the low-pass makes
ENDS: Final = 8  # rows at each end of a piece, where the filters of the effects have no neighbours
SHAKEN: Final = 2.0  # times the noise that rounding alone makes
SLIDING: Final = 0.25  # of the mean load speed: slower, and the load's friction has no sure sign


@dataclass(frozen=True)
class Sums:
    """Means over rows of columns (b,) and response, and products of the columns less theirs with each other (b, b) and
    with the response less its (b,)."""

    z: Array
    y: float
    gram: Array
    right: Array


@dataclass(frozen=True)
class Rows:
    """One channel of one run: response (n,), baseline columns (n, b) and which columns of BASELINE they are. `own` are
    columns (n, q) whose coefficients no other run shares."""

    y: Array
    z: Array
    at: tuple[int, ...]
    keep: Array  # bool, before masking
    theta_m: Array  # rad, (n,)
    own: Array

    @cached_property
    def sums(self) -> Sums:
        """Of these rows: they never change, and are fitted many times over."""
        z, y = self.z.mean(0), self.y.mean()
        apart = self.z - z
        return Sums(z, float(y), apart.T @ apart, apart.T @ (self.y - y))


def is_measured(run: Recording, channel: str) -> bool:
    """Whether this run can say anything in that channel; one angle will do for a torque."""
    need = {"A": {"theta_m", "theta_l"}, "M": {"tau_m"}, "R": {"tau_m", "theta_m", "t"}, "L": {"tau_l"}}[channel]
    turns = run.procedure != "standstill" and not (run.locked and channel in "RL")
    return turns and need <= run.knows


def rows(run: Recording, channel: str) -> Rows:
    """Response and baseline columns of a channel, pieces joined, masked rows gone."""
    y, z, at = unmasked(run, channel)
    keep = np.concatenate([valid(piece, run, channel) for piece in run.pieces])
    theta_m = np.concatenate([piece.theta_m[run.smoother.centres(piece.t.size)] for piece in run.pieces])
    keep &= np.isfinite(y) & np.isfinite(z).all(1)
    shared, z = shared_columns(run, channel, at), z[keep]
    if shared.all():  # most runs: theirs is the bulk of what a trace holds, and is copied no more than it must
        return Rows(y[keep], z, at, keep, theta_m[keep], np.zeros((len(z), 0)))
    places = tuple(i for i, mine in zip(at, shared, strict=True) if mine)
    return Rows(y[keep], z[:, shared], places, keep, theta_m[keep], z[:, ~shared])


def shared_columns(run: Recording, channel: str, at: tuple[int, ...]) -> npt.NDArray[np.bool_]:
    """Which baseline columns all runs share, (b,): all where there is time."""
    if "t" in run.has:
        return np.ones(len(at), dtype=np.bool_)
    rates = set(RATES) | (set(SERIES) | {"compliance"} if _derived(run, channel) else set())
    return np.array([BASELINE[i] not in rates for i in at], dtype=np.bool_)


def _derived(run: Recording, channel: str) -> bool:
    """Whether this channel stands in for an angle that was not measured."""
    needs = {"A": frozenset[str](), "L": {"theta_l"}}.get(channel, {"theta_m", "tau_l"})
    return not needs <= run.knows


def unmasked(run: Recording, channel: str) -> tuple[Array, Array, tuple[int, ...]]:
    """Response (n,), baseline columns (n, b) and their places, all rows."""
    make = {"A": _angle, "M": _motor, "R": _motor, "L": _load}[channel]
    made = [make(piece, run.smoother, run.knows) for piece in run.pieces]
    y, z = joined([m[0] for m in made]), joined([np.stack(list(m[1].values()), 1) for m in made])
    names = tuple(made[0][1])
    if channel == "M" and _shaken(run, z[:, names.index("J_m")]):
        z[:, names.index("J_m")] = 0.0
    return y, z, tuple(INDEX[name] for name in names)


def joined(parts: Sequence[Array]) -> Array:
    """One after the other, (n, ...); of one part no copy."""
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


def _shaken(run: Recording, alpha: Array) -> bool:
    """Whether ω̇_m (n,) of a run is the rounding of a coarse encoder and no more. A position loop answers that rounding
    with torque, so that J_m would come out too small, and no correction for noise that is independent could mend it."""
    noise = run.noise.get("theta_m", 0.0)
    if noise * (12 * run.thinned) ** 0.5 < 0.99 * COARSE:
        return False
    usual = float(np.nanmedian(np.abs(alpha))) / 0.6745  # the median does not see reversals
    return usual < SHAKEN * noise * run.smoother.gain(2)


def valid(piece: Signals, run: Recording, channel: str) -> Array:
    """Rows in which the channel's equation holds: all but the ends in A, where it moves; sliding ones in M and L, those
    beside them in R."""
    smooth = run.smoother
    inside = np.ones(smooth.rows(piece.t.size), dtype=bool)
    inside[:ENDS] = inside[-ENDS:] = False
    sliding = smooth(settled(piece).astype(float)) > 1 - 1e-9
    if channel == "R":
        return np.asarray(inside & ~sliding & (smooth((piece.way != 0).astype(float)) > 1 - 1e-9))
    if channel == "A":
        known = inside & _angle_known(piece, run)
        torque_known = run.locked or "tau_l" in run.knows
        return np.asarray(known if torque_known else known & sliding & _load_slides(piece, run))
    return np.asarray(inside & sliding & _load_slides(piece, run) if channel == "L" else inside & sliding)


def _load_slides(piece: Signals, run: Recording) -> npt.NDArray[np.bool_]:
    """Rows in which the load's friction has a sure sign, and with it the torque that was not measured."""
    smooth, moving = run.smoother, settled(piece)
    usual = float(np.median(np.abs(piece.omega_m[moving]))) / run.ratio if moving.any() else 0.0
    rate = smooth.same(piece.theta_l, 1) * piece.way
    return np.asarray(smooth((moving & (rate > SLIDING * usual)).astype(float)) > 1 - 1e-9)


def _angle_known(piece: Signals, run: Recording) -> npt.NDArray[np.bool_]:
    """Rows in which the motor's angle is known to better than a count; with a locked output one of every stay
    too, and none before the first reversal."""
    f = run.smoother
    rest = resting(piece.theta_m, piece.dt, run.counts_m, LOCKED if run.locked else FREE)
    if not run.locked:
        return np.asarray(f(rest.astype(float)) < 1e-9, dtype=np.bool_)
    stays = one_a_stay(rest[f.centres(piece.t.size)], round(4 * LOCKED / (f.dt * f.step)))
    return np.asarray(stays & has_turned(piece)[f.centres(piece.t.size)])


Columns = tuple[Array, dict[str, Array]]
Has = frozenset[str]


def _angle(s: Signals, f: Smoother, has: Has) -> Columns:
    y = f(s.theta_m / s.ratio - s.theta_l)
    columns = dict(zip(SERIES, f(series(s.theta_m)).T, strict=True))
    columns |= {"compliance": f(s.tau_l), "damping": f(s.tau_l, 1), "damping_2": f(s.tau_l, 2)}
    columns |= {"mesh": f(s.theta_m, 1), "c_0": np.ones_like(y)}
    if "tau_l" not in has:  # what the load's bearings take is missing in T
        columns |= {"B_l": f(s.theta_l, 1) / s.gear.K, "tau_cl": f(s.way) / s.gear.K}
    return y, columns


def third_rate(run: Recording) -> Array:
    """T⃛ of a run, pieces joined, all rows (n,)."""
    return joined([run.smoother(piece.tau_l, 3) for piece in run.pieces])


def _motor(s: Signals, f: Smoother, has: Has) -> Columns:
    y = f(s.tau_m - s.tau_l / s.ratio)
    lever = f(-s.tau_l[:, None] * slopes(s.theta_m))
    columns = dict(zip(SERIES, lever.T, strict=True))
    if "theta_m" not in has:
        columns = _with_angle(columns, s, f, has, s.gear.J_m * s.ratio)
    elif "theta_l" not in has and "tau_l" not in has:
        columns = _with_angle(columns, s, f, has, -s.gear.J_l / s.ratio)
    columns |= {"J_m": f(s.theta_m, 2), "B_m": f(s.theta_m, 1), "tau_c": f(s.way), "tau_0": np.ones_like(y)}
    if "tau_l" not in has and "theta_l" in has:  # what the load's bearings take is missing in T
        lever = 1 / s.ratio - s.series_slope
        columns |= {"B_l": f(s.omega_l * lever), "tau_cl": f(s.way * lever)}
    return y, columns


def _load(s: Signals, f: Smoother, has: Has) -> Columns:
    y = f(s.tau_l + s.tau_ext)
    columns = {"J_l": f(s.theta_l, 2), "B_l": f(s.theta_l, 1), "tau_cl": f(s.way), "tau_l0": np.ones_like(y)}
    if "theta_l" not in has:
        columns = _with_angle(columns, s, f, has, -s.gear.J_l)
    columns |= {"lag": -f(s.tau_l, 1)}
    return y, columns


def _with_angle(columns: dict[str, Array], s: Signals, f: Smoother, has: Has, inertia: float) -> dict[str, Array]:
    """With inertia·d²θ̃/dt² of A, in the place of an angle that was not measured."""
    waves = dict(zip(SERIES, inertia * f(series(s.theta_m), 2).T, strict=True))
    out = columns | {name: columns[name] + wave if name in columns else wave for name, wave in waves.items()}
    if "tau_l" not in has:
        return out
    return out | {"compliance": inertia * f(s.tau_l, 2), "damping": inertia * f(s.tau_l, 3)}


def series(theta: Array) -> Array:
    """cos nθ, sin nθ in turn, n = 1..15, shape (n, 30)."""
    return powers(theta, ORDERS)


def slopes(theta: Array) -> Array:
    """d/dθ of `series`, shape (n, 30)."""
    return powers(theta, ORDERS, slopes=True)


Mark = tuple[str, Array, int]
"""Channel, column (n, k) before the low-pass, and which derivative of it by time shows there."""


def _motor_torque(c: Array, s: Signals) -> Iterator[Mark]:
    yield "M", c, 0


def _load_torque(c: Array, s: Signals) -> Iterator[Mark]:
    yield "L", c, 0


def _kinematic_error(c: Array, s: Signals) -> Iterator[Mark]:
    yield "A", c, 0


def _lever(c: Array, s: Signals) -> Iterator[Mark]:
    yield "M", -s.torque[:, None] * c, 0


def _reads_theta_m(c: Array, s: Signals) -> Iterator[Mark]:
    yield "A", c * (1 / s.ratio - s.series_slope)[:, None], 0
    yield "M", -s.gear.J_m * c, 2


def _reads_theta_l(c: Array, s: Signals) -> Iterator[Mark]:
    yield "A", -c, 0
    yield "L", -s.gear.J_l * c, 2


def _reads_tau_m(c: Array, s: Signals) -> Iterator[Mark]:
    yield "M", c, 0


def _reads_tau_l(c: Array, s: Signals) -> Iterator[Mark]:
    k = s.gear.K
    yield "A", -c / k, 0
    yield "A", s.gear.B_sp / k**2 * c, 1
    yield "M", -c / s.ratio, 0
    yield "L", c, 0


FOOTPRINTS: Final[Mapping[Port, Callable[[Array, Signals], Iterator[Mark]]]] = {
    Port.MOTOR_TORQUE: _motor_torque,
    Port.LOAD_TORQUE: _load_torque,
    Port.KINEMATIC_ERROR: _kinematic_error,
    Port.WIND_UP: _kinematic_error,
    Port.LEVER: _lever,
    Port.READS_THETA_M: _reads_theta_m,
    Port.READS_THETA_L: _reads_theta_l,
    Port.READS_TAU_M: _reads_tau_m,
    Port.READS_TAU_L: _reads_tau_l,
}


def footprint(ports: Mapping[Port, Array], s: Signals, f: Smoother, has: Has) -> dict[str, Array]:
    """Columns at ports (n, k) → columns in channels (rows, k) of a run that measured the channels `has`."""
    out: dict[str, Array] = {}
    for port, columns in ports.items():
        for first in FOOTPRINTS[port](columns, s):
            for channel, column, order in _passed_on(first, s, has):
                made = f(column, order)
                out[channel] = out[channel] + made if channel in out else made
    return out | ({"R": out["M"]} if "M" in out else {})


def _passed_on(first: Mark, s: Signals, has: Has) -> Iterator[Mark]:
    """A column, and where else it shows for want of a sensor; a fourth derivative would be noise alone.

    Without time a derivative has no size that runs could share.
    """
    channel, column, order = first
    if order and "t" not in has:
        return
    yield first
    if channel == "A" and "t" in has and order < HIGHEST - 1:
        if "theta_l" not in has:
            yield from _passed_on(("L", -s.gear.J_l * column, order + 2), s, has)
        if "theta_m" not in has:
            yield "M", s.gear.J_m * s.ratio * column, order + 2
    if channel == "L" and "tau_l" not in has:
        yield "A", column / s.gear.K, order
        yield "M", column / s.ratio, order


def damping_of(coefficient: float, stiffness: float, lag: float) -> float:
    """B_sp [N·m·s/rad] from what stands before ṙ in A, −B_sp/K² + δ/K."""
    return (lag / stiffness - coefficient) * stiffness**2


def known_of(values: Mapping[str, float], before: Known = UNKNOWN) -> Known:
    """What effects may lean on, from the baseline's coefficients; what they do not say is as it was `before`."""
    stiffness = 1 / values["compliance"] if values["compliance"] > 0 else before.K
    measured = values["compliance"] > 0 and values["damping"] != 0.0
    return Known(
        K=stiffness,
        B_sp=damping_of(values["damping"], stiffness, values["lag"]) if measured else before.B_sp,
        J_m=values["J_m"] if values["J_m"] > 0 else before.J_m,
        J_l=values["J_l"] if values["J_l"] > 0 else before.J_l,
        torque_zero=values["tau_l0"],
        tau_c=max(values["tau_c"], 0.0),
        B_m=max(values["B_m"], 0.0),
        kinematic_error=FourierSeries(
            tuple(values[f"a{n}"] for n in range(1, ORDERS + 1)), tuple(values[f"b{n}"] for n in range(1, ORDERS + 1))
        ),
    )
