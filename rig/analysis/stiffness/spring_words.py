"""The spring of a lock test as a person is shown it: K1 to K3, cubic, play, local stiffness, lost motion."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from rig.analysis.findings.collected import Findings
from rig.analysis.findings.result import Array, Part
from rig.analysis.stiffness.choice import LeftOut
from rig.analysis.stiffness.curve import Curve
from rig.analysis.stiffness.laws import Play
from rig.analysis.stiffness.measure import SENSOR_GAIN, Stiffness
from rig.core.units import ARCMIN

RATED = 178.0  # N·m, size 40, ratio 50 [harmonicdrive]; where the bench declares none
LOST = 0.04  # of rated torque, as makers define lost motion
LEVELS = 6  # torques at which the local stiffness is tabulated


def half_width(values: Array, random: Array, relative: Array | float) -> Array:
    """Half width: what repeats badly, the slope of the kinematic error, and the gain of the sensor."""
    return np.asarray(np.hypot(random, np.abs(values) * np.hypot(relative, SENSOR_GAIN)))


def parts_of(value: float, random: float, tilt: float) -> tuple[Part, ...]:
    """What the interval of a stiffness is made of; `tilt` relative."""
    return (
        Part("how badly the ramps repeat", random, "run more cycles"),
        Part(
            "the slope of the kinematic error",
            abs(value) * tilt,
            "take a slow run in the same campaign, or --reference",
        ),
        Part(
            f"the gain of the torque sensor, {100 * SENSOR_GAIN:g} %", abs(value) * SENSOR_GAIN, "a better sensor only"
        ),
    )


def value_of(out: LeftOut, numbers: Callable[[Curve], Array]) -> tuple[Array, Array]:
    """Numbers of a curve and the half widths that leaving parts of the run out gives."""
    return numbers(out.curve), out.half(numbers)


def parameters(c: Curve) -> Array:
    return np.array(list(c.law.numbers(c.p, c.scale).values()))


def add_lines(found: Findings, s: Stiffness) -> None:
    """K1, K2, K3, and T1, T2 where they were fitted."""
    curve = s.spring.lines_out.curve
    values, random = value_of(s.spring.lines_out, parameters)
    half = half_width(values, random, np.array([*s.tilt.zones, 0.0, 0.0]))
    T = curve.law.numbers(curve.p, curve.scale)
    zones = (f"0 to {T['T1']:.3g} N·m", f"{T['T1']:.3g} to {T['T2']:.3g} N·m", f"above {T['T2']:.3g} N·m")
    ends = (0.0, T["T1"], T["T2"], s.tau_ref)
    for i, zone in enumerate(zones):
        how = f"Continuous straight lines by least squares, odd, both branches, {zone} either way. {s.spring.knots}"
        name = f"stiffness_K{i + 1}"
        value, parts = float(values[i]), parts_of(float(values[i]), float(random[i]), s.tilt.zones[i])
        over = (ends[i], ends[i + 1])
        found.figure(name, f"Stiffness K{i + 1}, {zone}", value, "N·m/rad", float(half[i]), how, *parts, over=over)
    if s.spring.fitted_knots:
        how = "Where the lines meet, fitted with them."
        for i, name in ((3, "T1"), (4, "T2")):
            found.figure(f"knot_{name}", f"Knot {name}", float(values[i]), "N·m", float(half[i]), how)


def add_cubic(found: Findings, s: Stiffness) -> None:
    curve = s.spring.cubic_out.curve
    values, random = value_of(s.spring.cubic_out, parameters)
    half = half_width(values, random, s.tilt.zones[0])
    # what bends the slope by a share of k1 over the reach passes for k3
    half[1] = float(np.hypot(half[1], s.tilt.zones[2] * values[0] / curve.scale.reach**2))
    how = "τ = k1·w + k3·w³ fitted to both branches with their loop."
    found.figure("cubic_k1", "Cubic law, k1", float(values[0]), "N·m/rad", float(half[0]), how)
    found.figure("cubic_k3", "Cubic law, k3", float(values[1]), "N·m/rad³", float(half[1]), how)


def add_play(found: Findings, s: Stiffness) -> None:
    """Backlash, where the run shows it."""
    if not isinstance(s.spring.chosen.curve.law, Play):
        return
    (_, b), (_, half) = value_of(s.spring.chosen_out, parameters)
    how = "Wind-up without torque, between the straight lines either side: backlash, at this motor angle."
    found.figure("play", "Play (dead zone)", 2 * b / ARCMIN, "arcmin", 2 * half / ARCMIN, how)


def add_tangent(found: Findings, s: Stiffness) -> None:
    """Local stiffness of the chosen law over torque, as a table."""
    levels = np.linspace(0.0, s.tau_ref, LEVELS)

    def tangent(c: Curve) -> Array:
        return c.tangent(c.middle + c.law.windup(levels, c.p, c.scale))

    values, random = value_of(s.spring.chosen_out, tangent)
    half = half_width(values, random, max(s.tilt.zones))
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


def add_lost_motion(found: Findings, s: Stiffness, rated: float | None) -> None:
    """The wind-up between ±4 % of the rated torque, as makers give it, or why it cannot be told."""
    torque = LOST * (rated or RATED)
    if torque > s.tau_ref:
        found.cannot.append(f"Lost motion: ±{torque:.3g} N·m (4 % of rated) is more than was tested.")
        return

    def lost(c: Curve) -> Array:
        return 2.0 / ARCMIN * c.law.windup(np.array([torque]), c.p, c.scale)

    value, random = value_of(s.spring.chosen_out, lost)
    half = half_width(value, random, s.tilt.zones[0])
    whose = "as declared" if rated else "of the catalogue for size 40, ratio 50; the bench declares none"
    how = f"Wind-up of the spring, loop taken out, between ±{torque:.3g} N·m: ±4 % of a rated torque {whose}."
    found.figure("lost_motion", "Lost motion", float(value[0]), "arcmin", float(half[0]), how)
