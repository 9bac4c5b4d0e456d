"""A lock test as a person is shown it: the stiffness figures, what they rest on, and what the run cannot tell."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.collected import Findings
from rig.analysis.findings.result import Array, Check
from rig.analysis.kinematic_error.reference import kinematic_error_reference
from rig.analysis.motion.declared import declared, far_off
from rig.analysis.motion.source import Motion, Source
from rig.analysis.motion.tame import Tame
from rig.analysis.stiffness.counts import one_count
from rig.analysis.stiffness.curve import Curve
from rig.analysis.stiffness.drawn import add_curves
from rig.analysis.stiffness.loop_words import add_creep, add_loop
from rig.analysis.stiffness.measure import SENSOR_GAIN, Stiffness, measure, windup_of
from rig.analysis.stiffness.other_units import torques_apart, winds_beyond
from rig.analysis.stiffness.path import Path, path_of
from rig.analysis.stiffness.spring_words import (
    add_cubic,
    add_lines,
    add_lost_motion,
    add_play,
    add_tangent,
    half_width,
    parts_of,
    value_of,
)
from rig.core.units import DEG, TURN

MOVES = 0.05  # of the wind-up: a load that moves more is not locked


def add_stiffness(found: Findings, run: Source, motion: Motion, reference: Source | None) -> None:
    """Everything a lock test says. `reference` is a slow run of the same campaign, for the kinematic error."""
    tau = motion.pick(run.column("tau_l"))
    if tau is None or not np.isfinite(tau).all():
        found.cannot.append("No complete shaft torque was recorded: the stiffness cannot be had.")
        found.sentence = "A lock test without shaft torque says nothing about stiffness."
        return
    _check_lock(found, motion)
    if _falls(windup_of(motion), tau):
        found.sentence = "The shaft torque falls as the gear is wound up: one sensor has the wrong sign."
        found.reject(found.sentence)
        return
    apart = winds_beyond(motion) or torques_apart(motion, tau, motion.pick(run.column("tau_m")))
    if apart:
        found.cannot.append(apart)
        found.inconclusive = apart
    T1, T2 = declared(run.declared, "T1"), declared(run.declared, "T2")
    error = None if reference is None else kinematic_error_reference(Tame(reference))
    s = measure(motion, tau, error, (T1, T2) if T1 and T2 else None, one_count(run, motion))
    if s is None:
        found.sentence = "No ramp of torque long enough for a slope was found."
        found.cannot.append(found.sentence)
        return
    less = f", less the kinematic error of {reference.name}" if reference is not None and s.share is not None else ""
    K, half = _add_secant(found, s, motion)
    said = declared(run.declared, "K")
    found.beyond = found.beyond or (far_off("K", K, said) if said else "")
    add_lines(found, s)
    add_cubic(found, s)
    add_play(found, s)
    add_tangent(found, s)
    add_lost_motion(found, s, declared(run.declared, "T_rated"))
    gap = add_loop(found, s)
    add_creep(found, s)
    _add_path(found, path_of(run.declared), K, half)
    _doubts(found, s)
    interval = f"({K - half:.0f} to {K + half:.0f}{less})"
    found.sentence = f"System torsional stiffness {K:.0f} N·m/rad {interval}{gap}; {_law(s)}."
    found.sentence = f"{apart} {found.sentence}" if apart else found.sentence
    add_curves(found, s)


def _check_lock(found: Findings, motion: Motion) -> None:
    if motion.theta_l is None:
        found.cannot.append("No load angle: whatever the lock gives way is counted as the gear's.")
        return
    moved = float(np.ptp(motion.theta_l)) / max(float(np.ptp(windup_of(motion))), 1e-300)
    text = f"The output moved {100 * moved:.2f} % of the wind-up, limit {100 * MOVES:g} % (it is taken off)."
    found.checks.append(Check("output_locked", moved < MOVES, text))


def _falls(windup: Array, tau: Array) -> bool:
    """Whether torque and wind-up run against each other, which no spring does."""
    w, y = windup - windup.mean(), tau - tau.mean()
    return float(w @ y) < -0.5 * float(np.sqrt((w @ w) * (y @ y)))


def _range(s: Stiffness) -> str:
    n = len(s.run.ramps)
    tau = s.run.points.tau
    return f"{n} {'ramp' if n == 1 else 'ramps'}, {tau.min():.1f} to {tau.max():.1f} N·m"


def _add_secant(found: Findings, s: Stiffness, motion: Motion) -> tuple[float, float]:
    """Stiffness and half the width of its 95 % interval, N·m/rad."""

    def secant(curve: Curve) -> Array:
        return s.tau_ref / curve.law.windup(np.array([s.tau_ref]), curve.p, curve.scale)

    value, random = value_of(s.spring.chosen_out, secant)
    half = float(half_width(value, random, s.tilt.secant)[0])
    how = (
        f"±{s.tau_ref:.3g} N·m over the wind-up θ_m/N − θ_l the fitted spring needs for it; {_range(s)}. Interval: "
        f"leaving out ramps and zones ±{100 * float(random[0] / value[0]):.2g} %, gain of the torque sensor "
        f"±{100 * SENSOR_GAIN:g} % (taken as class 0.2). {s.tilt.words}"
    )
    parts = parts_of(float(value[0]), float(random[0]), s.tilt.secant)
    label = "System torsional stiffness, secant"
    found.figure("torsional_stiffness", label, float(value[0]), "N·m/rad", half, how, *parts)
    angle = round(float(np.median(motion.theta_m)) % TURN / DEG, 1) % 360.0
    how = "Middle of the motor angles of this run, by the motor encoder's own zero: the stiffness holds there."
    found.exact("wave_generator_angle", "Wave-generator angle", angle, "°", how)
    return float(value[0]), half


def _add_path(found: Findings, path: Path | None, K: float, half: float) -> None:
    """The gear alone, where what lies in series is declared."""
    if path is None:
        found.cannot.append(
            "Gear alone: the figure is the whole path between motor encoder and lock; declare K_sensor, K_coupling or "
            "K_fixture to take torque sensor, couplings and fixture off."
        )
        return
    value, low, high = (path.gear(k) for k in (K, K - half, K + half))
    if not np.isfinite(value):
        found.cannot.append(f"Gear alone: {path.words()} in series are softer than the {K:.0f} N·m/rad measured.")
        return
    how = f"1/K_gear = 1/K − 1/K_i with {path.words()} as declared, taken for exact."
    label = "Torsional stiffness of the gear alone"
    found.figure("torsional_stiffness_gear", label, value, "N·m/rad", max(high - value, value - low), how)


def _law(s: Stiffness) -> str:
    """Which law describes the curve, in words."""
    *given, _ = s.spring.trials
    chosen = s.spring.chosen
    if chosen is given[0]:
        return "one line describes it: K1, K2 and K3 are not told apart"
    other = min((t for t in given if t is not chosen), key=lambda t: t.rms)
    return (
        f"{chosen.curve.law.words} describes it better (misses points left out by {chosen.rms:.2g} N·m rms) than "
        f"{other.curve.law.words} ({other.rms:.2g} N·m)"
    )


def _doubts(found: Findings, s: Stiffness) -> None:
    found.cannot.append(
        "Stiffness that changes with the wave-generator angle: this is one angle; it takes six or more, spread over "
        "half a turn, with the output freed between."
    )
    if s.share is None:
        found.cannot.append(
            "Kinematic error and spring: without a slow run of this campaign a bend of one passes for one of the other."
        )
    found.cannot.append(
        "Hysteresis of the torque sensor itself: it looks like the gear's; dead weights on the sensor tell them apart."
    )
