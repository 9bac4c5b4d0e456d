"""Stand-ins for readings that are not there, so that columns have something to lean on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rig.analysis.motion.source import Source
from rig.analysis.tracing.runs.declared import believed, is_locked
from rig.analysis.tracing.runs.smoothing import flat, flat_rate
from rig.analysis.tracing.runs.wound import wound
from rig.model.effect import Array, Known, Signals


def substituted(c: Mapping[str, Array], dt: float, run: Source, tau_ext: float, timed: bool) -> dict[str, Array]:
    """Stand-ins for readings that are not there, so that columns have something to lean on.

    The shaft torque of a free load is what its declared inertia and weight take, the weight alone where no time tells
    an acceleration; that of a locked one what the wind-up takes; one angle is the other's times N, that of the motor
    ahead by the wind-up, and a locked output rests.
    """
    out = dict(c)
    if not np.isfinite(out["theta_m"]).any():
        out["theta_m"] = _wound_up(out, run, tau_ext)
    if not np.isfinite(out["theta_l"]).any():
        out["theta_l"] = np.zeros_like(out["theta_m"]) if is_locked(run) else out["theta_m"] / run.ratio
    if np.isfinite(out["tau_l"]).any():
        return out
    gear = believed(run)
    if is_locked(run):
        if told := wound(out["theta_m"], out["theta_l"], out["tau_m"], run.ratio, gear, dt):
            out["tau_l"] = told.torque
    elif timed:
        out["tau_l"] = gear.J_l * flat_rate(out["theta_l"], dt, 2) - tau_ext
    else:
        out["tau_l"] = np.full_like(out["theta_l"], -tau_ext)
    return out


def _wound_up(c: Mapping[str, Array], run: Source, tau_ext: float) -> Array:
    """θ_m of a motor that nobody read, by the wind-up that a sensor or the weight tells: 40 N·m turn it a quarter of a
    radian further than the load says, at ratio 50, and the phase of order 4 by one."""
    torque = flat(c["tau_l"]) if np.isfinite(c["tau_l"]).all() else -tau_ext
    return np.asarray(run.ratio * (c["theta_l"] + torque / believed(run).K))


def reloaded(piece: Signals, known: Known, carried: Array | None, timed: bool) -> Signals:
    """With the torque of a load as far as the gear is `known` by now, and what effects in the load take, (n,)."""
    inertia = known.J_l * flat_rate(piece.theta_l, piece.dt, 2) if timed else 0.0
    torque = inertia - piece.tau_ext if carried is None else inertia - piece.tau_ext + carried
    rate = flat_rate(torque, piece.dt, 1)
    through = flat(torque) + rubbing(piece, known)
    return replace(piece, gear=known, carried=carried, tau_l=torque, torque=through, torque_rate=rate)


def rubbing(piece: Signals, known: Known) -> Array:
    """What the load's bearings take of a torque that nobody read, as far as the gear is `known`, (n,): of the torque
    that effects go by, while in the equations it has columns of its own. A kinematic error that shrinks under 3 N·m
    has lost a seventh of that under 0.5 N·m of friction, and A_inf would come out so much too high."""
    return np.asarray(known.tau_cl * piece.way + known.B_l * piece.omega_l)


def in_stand_ins(added: Mapping[str, Array], piece: Signals, dt: float, locked: bool, timed: bool) -> dict[str, Array]:
    """What the noise of readings does to those `substituted` made of them: the torque of a load's inertia has its
    encoder's noise twice differentiated, that of a wind-up both encoders' times the spring."""
    out: dict[str, Array] = {}
    if "theta_m" not in added and "theta_l" in added:
        out["theta_m"] = added["theta_l"] * piece.ratio
    if "theta_l" not in added and "theta_m" in added and np.any(piece.theta_l):
        out["theta_l"] = added["theta_m"] / piece.ratio
    if "tau_l" in added:
        return out
    angles = {**added, **out}
    if locked and "theta_m" in angles:
        out["tau_l"] = piece.gear.K * (angles["theta_m"] / piece.ratio - angles.get("theta_l", 0.0))
    elif not locked and timed and "theta_l" in angles:
        out["tau_l"] = piece.gear.J_l * flat_rate(angles["theta_l"], dt, 2)
    return out


def rewound(piece: Signals, known: Known) -> Signals:
    """With the torque of the wind-up, as far as the gear is `known` by now; of a spring that no free run has wound up
    the K by which that was told."""
    told = wound(piece.theta_m, piece.theta_l, piece.tau_m, piece.ratio, known, piece.dt)
    if told is None or not np.isfinite(piece.tau_l).all():
        return replace(piece, gear=known)
    gear = known if known.B_sp else replace(known, K=told.K)
    rate = flat_rate(told.torque, piece.dt, 1)
    return replace(piece, gear=gear, tau_l=told.torque, torque=flat(told.bent), torque_rate=rate, stiffness=told.local)
