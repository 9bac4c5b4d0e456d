"""The three equations of the rig as linear regressions: what each says of a run, and by which columns.

With θ̃ = θ_m/N − θ_l, the shaft torque T and the paper's θ̃_p      [ghorbel2001, Eqs. 1, 6-8]

    A (rad)  θ̃ = c_0 + θ̃_p(θ_m) + T/K − (B_sp/K²)·Ṫ + (B_sp²/K³)·T̈ + (B_ml/K)·ω_m
    M (N·m)  τ_m − T/N = τ_0 − T·θ̃_p′(θ_m) + J_m·ω̇_m + B_m·ω_m + τ_c·sgn ω_m
    R        M where the motor has just turned back, or soon will: friction that builds up over milliradians
    L (N·m)  T + τ_ext = J_l·ω̇_l + B_l·ω_l + τ_cl·sgn ω_l + z

Where they are looked for (runs/look.py) M has g·T/N too, the share by which the motor's torque reads more than the
sensor, and −δ_m·τ̇_m of a motor's torque that is read δ_m late, or early.

T = r + δ·ṙ of the reading r: every torque sensor has a low-pass of its own, 0.16 ms for one of 1 kHz, and at 500 rpm a
tenth of a millisecond stands above the noise of L. The torque sensor's zero z wanders from run to run, and c_0 may: how
far is read from repeats. B_ml shows in
A only when the torque sensor sits behind the mesh's own drag; it is known to be small.

A sensor that is not there takes one equation away, and what it would have said is put into the others:

no torque sensor   T = J_l·ω̇_l − τ_ext from L with the inertia declared, and what else L says stands in A and M;
                   of a locked output T = K·(θ̃ − θ̃_p), and what else A says stands in M
no load angle      θ_l = θ_m/N − θ̃ from A, in L: J_l·(ω̇_m/N − d²θ̃/dt²)
no motor angle     θ_m = N·(θ_l + θ̃) from A, in M: J_m·N·(ω̇_l + d²θ̃/dt²)
one side unread    in M, orders that this side answers by its resonance are each run's own (runs/answered.py)
no time            rows have no known distance: whatever is a rate belongs to each run alone
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.fit.holding import holds
from rig.analysis.tracing.fit.unread_load import beside_load
from rig.analysis.tracing.runs.answered import answered, lowest_answered
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.runs.resolution import COARSE
from rig.analysis.tracing.runs.smoothing import Smoother
from rig.model.effect import Array, Signals
from rig.model.fourier import PAPER_ORDERS
from rig.model.waves import powers

ORDERS: Final = PAPER_ORDERS  # terms of θ̃_p      [ghorbel2001, Eq. 8]


class Channel(NamedTuple):
    """What one of the equations says: the sensor's column it is compared in, by which key a trace tells of it, what
    that is in words, and its unit."""

    sensor: str
    key: str
    name: str
    unit: str


AT_REVERSALS: Final = "tau_m_at_reversals"  # beside the sensors' names: the motor torque where the motor turns back
CHANNEL: Final = {
    "A": Channel("theta_l", "theta_l", "kinematic error", "rad"),
    "M": Channel("tau_m", "tau_m", "motor torque", "N·m"),
    "R": Channel("tau_m", AT_REVERSALS, "motor torque at reversals", "N·m"),
    "L": Channel("tau_l", "tau_l", "shaft torque", "N·m"),
}
"""By letter."""
CHANNELS: Final = tuple(CHANNEL)
WHOLE: Final = ("A", "M", "L")
"""Those that hold all along a run; R is M where the motor has just turned back."""
SENSOR_NAMES: Final = {CHANNEL[c].key: CHANNEL[c].name for c in WHOLE}
"""What is compared in each sensor, in words."""
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
    "gain",
    "inertia",
    "lag_m",
)
INDEX: Final = {name: i for i, name in enumerate(BASELINE)}
RATES: Final = frozenset({"damping", "damping_2", "mesh", "J_m", "B_m", "J_l", "B_l", "lag", "inertia", "lag_m"})
"""Coefficients of derivatives by time."""
WIND_UP: Final = ("compliance", "damping", "damping_2")
"""Of the spring, in A."""
NEEDS: Final[Mapping[str, frozenset[str]]] = {
    "A": frozenset({"theta_m", "theta_l"}),
    "M": frozenset({"tau_m"}),
    "R": frozenset({"tau_m", "theta_m", "tau_l", "t"}),
    "L": frozenset({"tau_l"}),
}
"""What has to be measured for a channel."""
ROUNDING: Final = 1e-12  # relative
SHAKEN: Final = 2.0  # times the noise that rounding alone makes


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
    theta_m: Array  # rad, (n,); of a motor that is locked what the load goes, there
    own: Array

    @cached_property
    def sums(self) -> Sums:
        """Of these rows: they never change, and are fitted many times over."""
        z, y = self.z.mean(0), self.y.mean()
        apart = self.z - z
        # of a constant, as the way is in a run that never turns back, rounding is left: it would be taken for a column
        apart[:, np.sqrt(np.mean(apart**2, 0)) < ROUNDING * np.abs(z)] = 0.0
        return Sums(z, float(y), apart.T @ apart, apart.T @ (self.y - y))


def is_measured(run: Recording, channel: str) -> bool:
    """Whether this run can say anything in that channel; one angle will do for a torque. Where the motor turns back,
    what stands in for a torque sensor lacks the load's friction, which turns over later, and a lock test is looked at
    there only where friction is seen to build up; of a lock test without that sensor the angles are spent on its
    torque."""
    silent = run.locked and (channel == "L" or (channel == "R" and not run.look.reversals))
    turns = run.procedure != "standstill" and not silent
    turns &= not (run.input_locked and channel == "M")  # what holds it takes any torque
    spent = channel == "A" and run.is_wound and not run.look.held_load
    return turns and not spent and NEEDS[channel] <= run.knows


def rows(run: Recording, channel: str) -> Rows:
    """Response and baseline columns of a channel, pieces joined, masked rows gone."""
    y, z, at = unmasked(run, channel)
    keep = np.concatenate([holds(piece, run, channel) for piece in run.pieces])
    theta_m = np.concatenate([run.wound(piece)[run.smoother.centres(piece.t.size)] for piece in run.pieces])
    keep &= np.isfinite(y) & np.isfinite(z).all(1)
    shared, z = shared_columns(run, channel, at), z[keep]
    own = _own(run, channel, keep.size)[keep]
    if shared.all():  # most runs: theirs is the bulk of what a trace holds, and is copied no more than it must
        return Rows(y[keep], z, at, keep, theta_m[keep], own)
    places = tuple(i for i, mine in zip(at, shared, strict=True) if mine)
    return Rows(y[keep], z[:, shared], places, keep, theta_m[keep], np.hstack([z[:, ~shared], own]))


def again(run: Recording, channel: str, before: Rows) -> Rows:
    """The same rows, made of what is known of the gear by now."""
    y, z, at = unmasked(run, channel)
    shared, y, z = shared_columns(run, channel, at), y[before.keep], z[before.keep]
    places = tuple(i for i, mine in zip(at, shared, strict=True) if mine)
    own = _own(run, channel, before.keep.size)[before.keep]
    return Rows(y, z[:, shared], places, before.keep, before.theta_m, np.hstack([z[:, ~shared], own]))


def _own(run: Recording, channel: str, n: int) -> Array:
    """Columns of M and R whose coefficients are each run's own, pieces joined, all rows (n, q); of the others none."""
    if channel in "MR" and run.locked:
        return _held_torque(run)
    if channel == "M" and np.isfinite(lowest_answered(run)):
        return answered(run)
    return np.zeros((n, 0))


def _held_torque(run: Recording) -> Array:
    """T of a lock test, pieces joined, all rows (n, 1). A torque sensor's gain is good to some tenths of a per cent, a
    motor's torque constant to less, and both drift: at such torques that is several floors of M, and what of it lies
    along T is each test's own. Left to all it would go into θ̃_p′, which stands before T there.

    Without the sensor the friction that is the same all along is the test's own too, (n, 3): a friction that falls
    with speed or grows with load, and one beside the spring, would all be that much. And so is a constant: the clamp
    turns the output a little."""
    f = run.smoother.of("M")
    gain = joined([f(piece.tau_l) for piece in run.pieces])
    if not run.is_wound:
        return gain[:, None]
    way = joined([f(piece.way) for piece in run.pieces])
    return np.stack([gain, way, np.ones_like(way)], 1)


def shared_columns(run: Recording, channel: str, at: tuple[int, ...]) -> npt.NDArray[np.bool_]:
    """Which baseline columns all runs share, (b,): all where there is time."""
    if "t" in run.has:
        return np.ones(len(at), dtype=np.bool_)
    rates = set(RATES) | (set(SERIES) | {"compliance"} if _derived(run, channel) else set())
    return np.array([BASELINE[i] not in rates for i in at], dtype=np.bool_)


def later_by_a_second(run: Recording, channel: str) -> list[Array]:
    """What a motor torque read a second late has less than one read in time, −τ̇_m, to the first order: of each piece
    (n,), as smooth as `channel`."""
    f = run.smoother.of(channel)
    return [-f(piece.tau_m, 1) for piece in run.pieces]


def _derived(run: Recording, channel: str) -> bool:
    """Whether this channel stands in for an angle that was not measured."""
    needs = {"A": frozenset[str](), "L": {"theta_l"}}.get(channel, {"theta_m", "tau_l"})
    return not needs <= run.knows


def unmasked(run: Recording, channel: str) -> tuple[Array, Array, tuple[int, ...]]:
    """Response (n,), baseline columns (n, b) and their places, all rows."""
    make = {"A": _held if run.look.held_load else _angle, "M": _motor, "R": _motor, "L": _load}[channel]
    f = run.smoother.of(channel)
    made = [make(piece, f, run.knows) for piece in run.pieces]
    if channel == "M" and run.is_wound:
        made = [_wound(y, z, piece, f) for (y, z), piece in zip(made, run.pieces, strict=True)]
    if run.look.gain and channel in "MR" and "tau_l" in run.has:
        made = [(y, z | {"gain": f(p.tau_l) / p.ratio}) for (y, z), p in zip(made, run.pieces, strict=True)]
    if run.look.late_motor and channel in "MR" and "t" in run.has:
        late = later_by_a_second(run, channel)
        made = [(y, z | {"lag_m": x}) for (y, z), x in zip(made, late, strict=True)]
    if run.added and channel == "L":
        made = [(y - run.added * f(p.theta_l, 2), z) for (y, z), p in zip(made, run.pieces, strict=True)]
    if run.load_unread and channel in "AM":
        made = [beside_load(channel, *m, p, run) for m, p in zip(made, run.pieces, strict=True)]
    y, z = joined([m[0] for m in made]), joined([np.stack(list(m[1].values()), 1) for m in made])
    names = tuple(made[0][1])
    if channel == "A" and run.look.rigid and not run.carries:
        y = y - _believed_wind_up(run)
        z[:, [names.index(name) for name in WIND_UP if name in names]] = 0.0
    if run.input_locked:  # a shaft that gives a little way tells nothing of waves at other angles
        z[:, [i for i, name in enumerate(names) if name in (*SERIES, "mesh")]] = 0.0
    if channel == "M" and _shaken(run, z[:, names.index("J_m")]):
        z[:, names.index("J_m")] = 0.0
    if channel == "M" and np.isfinite(lowest := lowest_answered(run)):
        # beside waves of the run's own nothing of these is left but the noise that they are made of
        spent = {f"{part}{n}" for n in range(int(lowest), ORDERS + 1) for part in "ab"}
        spent |= set[str]() if "theta_m" in run.has else {"J_m", "compliance", "damping"}
        z[:, [i for i, name in enumerate(names) if name in spent]] = 0.0
    return y, z, tuple(INDEX[name] for name in names)


def joined(parts: Sequence[Array]) -> Array:
    """One after the other, (n, ...); of one part no copy."""
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


def _believed_wind_up(run: Recording) -> Array:
    """T/K of a run, pieces joined, all rows (n,), by what is declared of inertia and spring; 0 where nothing is: then
    θ̃_p is what the kinematic error is at that speed."""
    known = {"K", "J_l"} <= run.declared.keys()
    return joined([run.smoother(piece.tau_l) * (known / piece.gear.K) for piece in run.pieces])


def _shaken(run: Recording, alpha: Array) -> bool:
    """Whether ω̇_m (n,) of a run is the rounding of a coarse encoder and no more. A position loop answers that rounding
    with torque, so that J_m would come out too small, and no correction for noise that is independent could mend it."""
    noise = run.noise.get("theta_m", 0.0)
    if noise * (12 * run.thinned) ** 0.5 < 0.99 * COARSE:
        return False
    usual = float(np.nanmedian(np.abs(alpha))) / 0.6745  # the median does not see reversals
    return usual < SHAKEN * noise * run.smoother.of("M").gain(2)


Columns = tuple[Array, dict[str, Array]]
Has = frozenset[str]


def _angle(s: Signals, f: Smoother, has: Has) -> Columns:
    y = f(s.theta_m / s.ratio - s.theta_l)
    columns = dict(zip(SERIES, f(series(s.theta_m)).T, strict=True))
    columns |= {"compliance": f(s.tau_l), "damping": f(s.tau_l, 1), "damping_2": f(s.tau_l, 2)}
    columns |= {"mesh": f(s.theta_m, 1), "c_0": np.ones_like(y)}
    if "tau_l" not in has:  # what the load's bearings take is missing in T
        columns |= {"tau_cl": f(s.way) / s.gear.K}
        if "t" in has:  # else, beside the rate of the motor's angle, it would be that of θ̃ itself
            columns |= {"B_l": f(s.theta_l, 1) / s.gear.K}
    return y, columns


def _held(s: Signals, f: Smoother, has: Has) -> Columns:
    """A of an output that is locked, without the wind-up: what its encoder reads, which should be nothing."""
    y = f(-s.theta_l)
    return y, {"c_0": np.ones_like(y)}


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
    theta = s.theta_m if "theta_m" in has else s.theta_l * s.ratio  # what it is ahead by has columns of its own
    columns |= {"J_m": f(theta, 2), "B_m": f(theta, 1), "tau_c": f(s.way), "tau_0": np.ones_like(y)}
    if "tau_l" not in has and "theta_l" in has:  # what the load's bearings take is missing in T
        columns |= {"B_l": f(s.omega_l * s.lever), "tau_cl": f(s.way * s.lever)}
    return y, columns


def _wound(y: Array, columns: dict[str, Array], s: Signals, f: Smoother) -> Columns:
    """M where T is K·(θ̃ − θ̃_p): θ̃_p as known is put back, and has its own columns. The load rests: its bearings
    take nothing."""
    spring = np.full(s.t.size, s.gear.K) if s.stiffness is None else s.stiffness
    spring = spring / s.ratio
    waves = dict(zip(SERIES, -f(spring[:, None] * series(s.theta_m)).T, strict=True))
    columns = {name: column for name, column in columns.items() if name not in ("B_l", "tau_cl")}
    return y - f(spring * s.series_value), columns | {name: columns[name] + wave for name, wave in waves.items()}


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
