"""Output locked, motor winds the gear up and down: secant slope and loop width, nothing finer."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rig.analysis.angle import ARCMIN, ARCSEC, transmission_error
from rig.analysis.findings import Findings
from rig.analysis.intervals import t95
from rig.analysis.result import Array, Check
from rig.analysis.source import Motion, Source
from rig.analysis.strokes import turning_points

RAMP = 0.4  # of the whole torque range: a shorter ramp is not used
NEAR_ZERO = 0.15  # of the largest torque: the line through these rows says where the ramp crosses zero torque
ERROR = 90.0 / ARCSEC  # rad   order 2 of an older gear (3 arcmin peak to peak), with a quarter as much of order 4
MOST = 3000  # points drawn


@dataclass(frozen=True)
class Ramp:
    """One way up or down: slope N·m/rad, wind-up at zero torque rad (NaN when it does not cross), direction."""

    slope: float
    at_zero: float
    direction: int
    full: bool  # most of the whole range, so its slope is a secant of both signs of torque


def ramps_of(windup: Array, tau: Array) -> list[Ramp]:
    """Cut at the turning points of the wind-up [rad]; `tau` N·m, both (n,)."""
    whole = float(np.ptp(windup))
    pivots = turning_points(windup, 0.1 * whole) if whole > 0 else []
    span, most = float(np.ptp(tau)), float(np.max(np.abs(tau)))
    out = []
    for lo, hi in pairwise(pivots) if span > 0 else ():
        w, y = windup[lo : hi + 1], tau[lo : hi + 1]
        if np.ptp(y) < RAMP * span or w.size < 16:
            continue
        x = w - w.mean()
        slope = float(x @ (y - y.mean())) / float(x @ x)
        # the first loading from rest starts inside the loop, not on it
        on_the_loop = abs(y[0]) > 0.5 * most
        crossing = _crossing(w, y, NEAR_ZERO * most) if on_the_loop else float("nan")
        out.append(Ramp(slope, crossing, 1 if w[-1] > w[0] else -1, bool(np.ptp(y) >= 0.8 * span)))
    return out


def _crossing(windup: Array, tau: Array, near: float) -> float:
    """Wind-up where the line through the rows with |torque| ≤ `near` is at zero torque; NaN when they stop short."""
    here = np.abs(tau) <= near
    if here.sum() < 8 or tau[here].min() > 0.2 * near or tau[here].max() < -0.2 * near:
        return float("nan")
    torque, angle = tau[here] - tau[here].mean(), windup[here]
    compliance = float(torque @ (angle - angle.mean())) / max(float(torque @ torque), 1e-300)
    return float(angle.mean() - tau[here].mean() * compliance)


def add_lock(found: Findings, run: Source, motion: Motion) -> None:
    """Secant stiffness and loop width of a lock test, from shaft torque against wind-up θ_m/N − θ_l."""
    tau = motion.pick(run.column("tau_l"))
    if tau is None or not np.isfinite(tau).all():
        found.cannot.append("No complete shaft torque was recorded: the stiffness cannot be had.")
        found.sentence = "A lock test without shaft torque says nothing about stiffness."
        return
    load = motion.theta_l if motion.theta_l is not None else np.zeros_like(motion.theta_m)
    windup = transmission_error(motion.theta_m, load, motion.ratio)
    moved = float(np.ptp(load)) / max(float(np.ptp(windup)), 1e-300)
    sentence = f"The output moved {100 * moved:.2f} % of the wind-up, limit 5 % (it is taken off)."
    found.checks.append(Check("output_locked", moved < 0.05, sentence))
    if motion.theta_l is None:
        found.cannot.append("No load angle: whatever the lock gives way is counted as the gear's.")
    ramps = ramps_of(windup, tau)
    if not ramps:
        found.sentence = "No ramp of torque long enough for a slope was found."
        found.cannot.append(found.sentence)
        return
    K, half = _add_stiffness(found, ramps, tau, motion.ratio)
    width = _add_loop_width(found, ramps)
    found.cannot += [
        "K1, K2, K3, hysteresis loss and creep: this is the secant of the whole loop, the full analysis comes later.",
        "Gear alone: the figure is the whole path between motor encoder and lock, torque sensor and fixture included.",
    ]
    found.sentence = f"System torsional stiffness {K:.0f} N·m/rad ({K - half:.0f} to {K + half:.0f}){width}."
    _add_curves(found, windup, tau, K)


def _add_stiffness(found: Findings, ramps: list[Ramp], tau: Array, ratio: float) -> tuple[float, float]:
    """Stiffness and the half width of its 95 % interval, N·m/rad."""
    used = [r for r in ramps if r.full] or ramps
    slopes = np.array([r.slope for r in used])
    K = float(slopes.mean())
    random = t95(slopes.size - 1) * float(slopes.std(ddof=1)) / np.sqrt(slopes.size) if slopes.size > 1 else 0.0
    # the motor turns over a piece of the kinematic error, whose slope N·θ̃_p′ looks like torsion: 2·C_2 + 4·C_4 at most
    tilt = (2.0 + 4.0 / 4.0) * ratio * ERROR
    half = float(np.hypot(random, 1.96 * tilt / np.sqrt(3.0) * abs(K)))
    ramp_count = f"{slopes.size} {'ramp' if slopes.size == 1 else 'ramps'}"
    repeat = f"the ramps repeat to ±{100 * random / abs(K):.2g} %" if slopes.size > 1 else "one ramp does not repeat"
    how = (
        f"Line through shaft torque against θ_m/N − θ_l, {ramp_count}, {tau.min():.1f} to {tau.max():.1f} N·m; "
        f"{repeat}, the rest of the interval (±{100 * tilt:.1f} % at most) "
        "is for the slope of the kinematic error at this motor angle, which this run does not know."
    )
    found.figure("torsional_stiffness", "System torsional stiffness, secant", K, "N·m/rad", half, how)
    return K, half


def _add_loop_width(found: Findings, ramps: list[Ramp]) -> str:
    """Wind-up between falling and rising ramps at zero torque; what the headline says of it."""
    up = np.array([r.at_zero for r in ramps if r.direction > 0 and np.isfinite(r.at_zero)])
    down = np.array([r.at_zero for r in ramps if r.direction < 0 and np.isfinite(r.at_zero)])
    if not (up.size and down.size):
        found.cannot.append("Zero torque was not crossed on the way up and on the way down: no loop width.")
        return ""
    width = float(down.mean() - up.mean()) * ARCMIN
    dof = up.size + down.size - 2
    how = f"Wind-up at zero torque, ramps falling ({down.size}) less rising ({up.size}); a sensor offset moves zero."
    spread = float("nan")
    if dof > 0:
        pooled = float(np.sqrt((np.sum((up - up.mean()) ** 2) + np.sum((down - down.mean()) ** 2)) / dof))
        spread = t95(dof) * pooled * float(np.sqrt(1 / up.size + 1 / down.size)) * ARCMIN
    else:
        how += " One ramp each way: no interval."
    found.figure("loop_width", "Loop width at zero torque", width, "arcmin", spread, how)
    return f", loop {width:.2f} arcmin wide at zero torque"


def _add_curves(found: Findings, windup: Array, tau: Array, K: float) -> None:
    step = max(tau.size // MOST, 1)
    ends = np.array([tau.min(), tau.max()])
    found.curve(
        torsion__torque=tau[::step],
        torsion__angle=(windup[::step] - float(windup.mean())) * ARCMIN,
        torsion__fit_torque=ends,
        torsion__fit_angle=(ends - float(tau.mean())) / K * ARCMIN,
    )
