"""A lock test as a person is shown it: the stiffness figures, what they rest on, and what the run cannot tell."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from rig.analysis.angle import ARCMIN, DEG, TURN
from rig.analysis.findings import Findings
from rig.analysis.flexibility import declared
from rig.analysis.reference import kinematic_error_reference
from rig.analysis.result import Array, Check
from rig.analysis.source import Motion, Source
from rig.analysis.stiffness.choice import LeftOut
from rig.analysis.stiffness.curve import Curve
from rig.analysis.stiffness.drawn import add_curves
from rig.analysis.stiffness.loop_words import add_creep, add_loop
from rig.analysis.stiffness.measure import SENSOR_GAIN, Stiffness, measure, windup_of
from rig.analysis.stiffness.path import Path, path_of
from rig.analysis.tame import Tame

RATED = 178.0  # N·m, size 40, ratio 50 [harmonicdrive]; where the bench declares none
LOST = 0.04  # of rated torque, as makers define lost motion
MOVES = 0.05  # of the wind-up: a load that moves more is not locked
LEVELS = 6  # torques at which the local stiffness is tabulated


def add_stiffness(found: Findings, run: Source, motion: Motion, reference: Source | None) -> None:
    """Everything a lock test says. `reference` is a slow run of the same campaign, for the kinematic error."""
    tau = motion.pick(run.column("tau_l"))
    if tau is None or not np.isfinite(tau).all():
        found.cannot.append("No complete shaft torque was recorded: the stiffness cannot be had.")
        found.sentence = "A lock test without shaft torque says nothing about stiffness."
        return
    _check_lock(found, motion)
    T1, T2 = declared(run.declared, "T1"), declared(run.declared, "T2")
    error = None if reference is None else kinematic_error_reference(Tame(reference))
    s = measure(motion, tau, error, (T1, T2) if T1 and T2 else None)
    if s is None:
        found.sentence = "No ramp of torque long enough for a slope was found."
        found.cannot.append(found.sentence)
        return
    K, half = _add_secant(found, s, motion)
    _add_lines(found, s)
    _add_cubic(found, s)
    _add_tangent(found, s)
    _add_lost_motion(found, s, declared(run.declared, "T_rated"))
    gap = add_loop(found, s)
    add_creep(found, s)
    _add_path(found, path_of(run.declared), K, half)
    _doubts(found, s)
    found.sentence = f"System torsional stiffness {K:.0f} N·m/rad ({K - half:.0f} to {K + half:.0f}){gap}; {_law(s)}."
    add_curves(found, s)


def _check_lock(found: Findings, motion: Motion) -> None:
    if motion.theta_l is None:
        found.cannot.append("No load angle: whatever the lock gives way is counted as the gear's.")
        return
    moved = float(np.ptp(motion.theta_l)) / max(float(np.ptp(windup_of(motion))), 1e-300)
    text = f"The output moved {100 * moved:.2f} % of the wind-up, limit {100 * MOVES:g} % (it is taken off)."
    found.checks.append(Check("output_locked", moved < MOVES, text))


def _half(values: Array, random: Array, relative: Array | float) -> Array:
    """Half width: what repeats badly, the slope of the kinematic error, and the gain of the sensor."""
    return np.asarray(np.hypot(random, np.abs(values) * np.hypot(relative, SENSOR_GAIN)))


def _value(out: LeftOut, numbers: Callable[[Curve], Array]) -> tuple[Array, Array]:
    """Numbers of a curve and the half widths that leaving parts of the run out gives."""
    return numbers(out.curve), out.half(numbers)


def _parameters(c: Curve) -> Array:
    return np.array(list(c.law.numbers(c.p, c.scale).values()))


def _range(s: Stiffness) -> str:
    n = len(s.run.ramps)
    tau = s.run.points.tau
    return f"{n} {'ramp' if n == 1 else 'ramps'}, {tau.min():.1f} to {tau.max():.1f} N·m"


def _add_secant(found: Findings, s: Stiffness, motion: Motion) -> tuple[float, float]:
    """Stiffness and half the width of its 95 % interval, N·m/rad."""

    def secant(curve: Curve) -> Array:
        return s.tau_ref / curve.law.windup(np.array([s.tau_ref]), curve.p, curve.scale)

    value, random = _value(s.spring.chosen_out, secant)
    half = float(_half(value, random, s.tilt.secant)[0])
    how = (
        f"±{s.tau_ref:.3g} N·m over the wind-up θ_m/N − θ_l the fitted spring needs for it; {_range(s)}. Interval: "
        f"leaving out ramps and zones ±{100 * float(random[0] / value[0]):.2g} %, gain of the torque sensor "
        f"±{100 * SENSOR_GAIN:g} % (taken as class 0.2). {s.tilt.words}"
    )
    found.figure("torsional_stiffness", "System torsional stiffness, secant", float(value[0]), "N·m/rad", half, how)
    angle = round(float(np.median(motion.theta_m)) % TURN * DEG, 1) % 360.0
    how = "Middle of the motor angles of this run, by the motor encoder's own zero: the stiffness holds there."
    found.exact("wave_generator_angle", "Wave-generator angle", angle, "°", how)
    return float(value[0]), half


def _add_lines(found: Findings, s: Stiffness) -> None:
    """K1, K2, K3, and T1, T2 where they were fitted."""
    curve = s.spring.lines_out.curve
    values, random = _value(s.spring.lines_out, _parameters)
    half = _half(values, random, np.array([*s.tilt.zones, 0.0, 0.0]))
    T = curve.law.numbers(curve.p, curve.scale)
    zones = (f"0 to {T['T1']:.3g} N·m", f"{T['T1']:.3g} to {T['T2']:.3g} N·m", f"above {T['T2']:.3g} N·m")
    for i, zone in enumerate(zones):
        how = f"Continuous straight lines by least squares, odd, both branches, {zone} either way. {s.spring.knots}"
        name = f"stiffness_K{i + 1}"
        found.figure(name, f"Stiffness K{i + 1}, {zone}", float(values[i]), "N·m/rad", float(half[i]), how)
    if s.spring.fitted_knots:
        how = "Where the lines meet, fitted with them."
        for i, name in ((3, "T1"), (4, "T2")):
            found.figure(f"knot_{name}", f"Knot {name}", float(values[i]), "N·m", float(half[i]), how)


def _add_cubic(found: Findings, s: Stiffness) -> None:
    curve = s.spring.cubic_out.curve
    values, random = _value(s.spring.cubic_out, _parameters)
    half = _half(values, random, s.tilt.zones[0])
    # what bends the slope by a share of k1 over the reach passes for k3
    half[1] = float(np.hypot(half[1], s.tilt.zones[2] * values[0] / curve.scale.reach**2))
    how = "τ = k1·w + k3·w³ fitted to both branches with their loop."
    found.figure("cubic_k1", "Cubic law, k1", float(values[0]), "N·m/rad", float(half[0]), how)
    found.figure("cubic_k3", "Cubic law, k3", float(values[1]), "N·m/rad³", float(half[1]), how)


def _add_tangent(found: Findings, s: Stiffness) -> None:
    """Local stiffness of the chosen law over torque, as a table."""
    levels = np.linspace(0.0, s.tau_ref, LEVELS)

    def tangent(c: Curve) -> Array:
        return c.tangent(c.middle + c.law.windup(levels, c.p, c.scale))

    values, random = _value(s.spring.chosen_out, tangent)
    half = _half(values, random, max(s.tilt.zones))
    found.tables["local_stiffness"] = [
        {"torque_nm": float(x), "local_stiffness_N·m/rad": float(k), "interval_±": float(h)}
        for x, k, h in zip(levels, values, half, strict=True)
    ]
    found.tables["spring_laws"] = [
        {
            "law": t.curve.law.words,
            "misses_left-out_points_by_nm": t.rms,
            "chosen": "yes" if t is s.spring.chosen else "no",
        }
        for t in s.spring.trials
    ]


def _add_lost_motion(found: Findings, s: Stiffness, rated: float | None) -> None:
    torque = LOST * (rated or RATED)
    if torque > s.tau_ref:
        found.cannot.append(f"Lost motion: ±{torque:.3g} N·m (4 % of rated) is more than was tested.")
        return

    def lost(c: Curve) -> Array:
        return 2.0 * ARCMIN * c.law.windup(np.array([torque]), c.p, c.scale)

    value, random = _value(s.spring.chosen_out, lost)
    half = _half(value, random, s.tilt.zones[0])
    whose = "as declared" if rated else "of the catalogue for size 40, ratio 50; the bench declares none"
    how = f"Wind-up of the spring, loop taken out, between ±{torque:.3g} N·m: ±4 % of a rated torque {whose}."
    found.figure("lost_motion", "Lost motion", float(value[0]), "arcmin", float(half[0]), how)


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
    line, cubic, lines, _ = s.spring.trials
    chosen = s.spring.chosen
    if chosen is line:
        return "one line describes it: K1, K2 and K3 are not told apart"
    other = min((t for t in (line, cubic, lines) if t is not chosen), key=lambda t: t.rms)
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
