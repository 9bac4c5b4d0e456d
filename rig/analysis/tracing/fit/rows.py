"""Rows of one channel of one run: its response and baseline columns, pieces joined, what says nothing masked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.fit.channels import BASELINE, INDEX, NEEDS, ORDERS, RATES, SERIES, WIND_UP
from rig.analysis.tracing.fit.columns import angle, held, load, motor, wound
from rig.analysis.tracing.fit.holding import holds
from rig.analysis.tracing.fit.unread_load import beside_load
from rig.analysis.tracing.runs.answered import answered, lowest_answered
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.runs.resolution import COARSE
from rig.model.effect import Array

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
    make = {"A": held if run.look.held_load else angle, "M": motor, "R": motor, "L": load}[channel]
    f = run.smoother.of(channel)
    made = [make(piece, f, run.knows) for piece in run.pieces]
    if channel == "M" and run.is_wound:
        made = [wound(y, z, piece, f) for (y, z), piece in zip(made, run.pieces, strict=True)]
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


def third_rate(run: Recording) -> Array:
    """T⃛ of a run, pieces joined, all rows (n,)."""
    return joined([run.smoother(piece.tau_l, 3) for piece in run.pieces])
