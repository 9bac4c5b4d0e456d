"""Coast-down: inertia at the motor from the torque that held the speed and the deceleration once it was gone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.collected import Findings, pm
from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Array, Check
from rig.analysis.friction.coast import FEWEST, SKIP, SLOWEST, Coast, Piece, fit_coasts
from rig.analysis.motion.declared import declared_gear
from rig.analysis.motion.source import Motion, Source
from rig.core.quantiles import Z95
from rig.core.units import RPM
from rig.model.linear import damping_ratio, natural_frequency

HELD = 1.0  # s before the torque was taken off, over which it is averaged
FAST = 10.0  # rad/s  slower motion is no coasting: the loop takes hold of a resting motor in the same way
METHOD = 0.02  # 1 σ of the inertia from what the law leaves out (kinematic error, friction below 3 rad/s), relative


@dataclass(frozen=True)
class Inertia:
    """What the coasts say together; each (value, half width of its 95 % interval)."""

    J: tuple[float, float]  # kg·m², at the motor, J_m + J_l/N²
    tau_c: tuple[float, float]  # N·m, Coulomb part, load side included
    B: tuple[float, float]  # N·m·s/rad, viscous part, load side included


def add_coast_down(found: Findings, run: Source, motion: Motion) -> None:
    """Add inertia, friction and the curves; says why where there is no coast."""
    pieces = _pieces(run, motion)
    if len(pieces) < 2:
        found.sentence = f"The run has {len(pieces)} coasts from above {FAST / RPM:.0f} rpm, expected at least 2."
        found.inconclusive = found.sentence
        found.cannot.append("Coasts need t, theta_m and the torque that was commanded.")
        return
    gear = declared_gear(run)
    swing = 0j if gear is None else natural_frequency(gear) * complex(-damping_ratio(gear), 1.0)
    coasts, b, u_b = fit_coasts(pieces, swing)
    result = together(coasts, b, u_b)
    _figures(found, result, coasts, b, u_b)
    if gear is None:
        found.cannot.append(
            "J_m, J_l or K is not declared: the swing of the load on the gear stays in the deceleration, and there is "
            "no inertia to compare with."
        )
    else:
        _check(found, result, gear.J_m + gear.J_l / gear.ratio**2)
    _curves(found, pieces, coasts, b)


def _pieces(run: Source, motion: Motion) -> list[Piece]:
    """The rows of every coast, from SKIP after the torque went to where friction is no longer Coulomb and viscous."""
    tau = motion.pick(run.column("tau_applied"))
    tau = motion.pick(run.column("tau_ask")) if tau is None else tau
    t, theta = motion.t, motion.theta_m
    if t is None or tau is None:
        return []
    off = (tau == 0.0) & np.isfinite(tau)
    edges = np.flatnonzero(np.diff(off.astype(np.int64), prepend=0, append=0))
    found = []
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        before = int(np.searchsorted(t, t[first] - HELD))
        begin = int(np.searchsorted(t, t[first] + SKIP))
        if first - before < FEWEST or last - begin < FEWEST:
            continue
        way = theta[first] - theta[before]
        if abs(way) < FAST * HELD:
            continue
        direction = 1 if way > 0 else -1
        end = _end(t[begin:last], direction * theta[begin:last])
        if end >= FEWEST:
            held = direction * float(np.mean(tau[before:first]))
            stop = begin + end
            turned = direction * (theta[begin:stop] - theta[begin])
            found.append(Piece(t[begin:stop] - t[first], turned, direction, held))
    return found


def _end(t: Array, theta: Array) -> int:
    """How many rows until the motor is slower than SLOWEST, seen over a tenth of the rows at a time."""
    size = min(max(FEWEST // 2, 8), t.size - 1)
    speed = (theta[size:] - theta[:-size]) / (t[size:] - t[:-size])
    slow = np.flatnonzero(speed < SLOWEST)
    return int(slow[0]) if slow.size else t.size


def together(coasts: list[Coast], b: float, u_b: float) -> Inertia:
    """J of each coast is τ_hold/(a + b·ω_0): what had held the speed is what then slows it. Means over the coasts."""
    J = np.array([c.tau_hold / (c.a + b * c.omega_0) for c in coasts])
    a = np.array([c.a for c in coasts])
    mean = float(J.mean())
    u_J = float(np.hypot(J.std(ddof=1) / np.sqrt(J.size), METHOD * mean))
    tau_c = J * a
    u_c = float(np.hypot(tau_c.std(ddof=1) / np.sqrt(J.size), METHOD * abs(tau_c.mean())))
    # a and b share what bends the coast: an error of b goes into a at mid-speed with the opposite sign
    u_c = float(np.hypot(u_c, mean * u_b * 0.5 * np.mean([c.omega_0 for c in coasts])))
    factor = t95(J.size - 1)
    u_B = float(np.hypot(mean * u_b, b * u_J))
    return Inertia((mean, factor * u_J), (float(tau_c.mean()), factor * u_c), (mean * b, factor * u_B))


def _figures(found: Findings, result: Inertia, coasts: list[Coast], b: float, u_b: float) -> None:
    n, fast = len(coasts), float(np.mean([c.omega_0 for c in coasts])) / RPM
    basis = f"{n} coasts from {fast:.0f} rpm to {SLOWEST / RPM:.0f} rpm, both directions"
    how = (
        f"Mean torque that held the speed over the deceleration right after it was taken off, {basis}; interval from "
        f"their scatter and {100 * METHOD:g} % (1 σ) for what the law leaves out."
    )
    found.figure("inertia_at_motor", "Inertia at the motor, J_m + J_l/N²", result.J[0], "kg·m²", result.J[1], how)
    law = f"ω̇ = −(τ_c + B·ω)/J fitted to {basis}; B common to all, its interval by leaving out one coast at a time."
    found.figure("coulomb_torque", "Coulomb friction at the motor", *_with(result.tau_c, "N·m"), law)
    found.figure("viscous_friction", "Viscous friction at the motor", *_with(result.B, "N·m·s/rad"), law)
    if b > 0 and 2.0 * Z95 * u_b < b:
        value, half = 1.0 / b, Z95 * u_b / b**2
        found.figure("time_constant", "Time constant J/B", value, "s", half, law)
    held = np.array([c.tau_hold for c in coasts])
    half = t95(n - 1) * float(held.std(ddof=1)) / np.sqrt(n)
    how = f"Mean torque over {HELD:g} s before it was taken off, {n} times, in the direction of motion."
    found.figure("holding_torque", "Torque that held the speed", float(held.mean()), "N·m", half, how)
    found.sentence = (
        f"Inertia at the motor {pm(*result.J, 'kg·m²')}, Coulomb friction {pm(*result.tau_c, 'N·m')}, drag "
        f"{pm(1e3 * result.B[0], 1e3 * result.B[1], 'mN·m·s/rad')}, from {basis}."
    )
    way = np.array([c.direction for c in coasts])
    if (way > 0).sum() > 1 and (way < 0).sum() > 1:
        forward, reverse = held[way > 0], held[way < 0]
        u = np.sqrt(forward.var(ddof=1) / forward.size + reverse.var(ddof=1) / reverse.size)
        found.figure(
            "holding_torque_difference",
            "Torque forward less reverse",
            float(forward.mean() - reverse.mean()),
            "N·m",
            t95(n - 2) * float(u),
            "Difference of the means of both directions: friction that depends on direction, or a torque zero; "
            "interval from the scatter of the coasts.",
        )


def _with(figure: tuple[float, float], unit: str) -> tuple[float, str, float]:
    return figure[0], unit, figure[1]


def _check(found: Findings, result: Inertia, declared: float) -> None:
    value, half = result.J
    agrees = abs(value - declared) <= half
    word = "agrees with" if agrees else "disagrees with"
    text = (
        f"The inertia at the motor, {pm(value, half, 'kg·m²')}, {word} the declared J_m + J_l/N² of "
        f"{declared:.4g} kg·m²."
    )
    found.checks.append(Check("inertia_as_declared", agrees, text))


def _curves(found: Findings, pieces: list[Piece], coasts: list[Coast], b: float) -> None:
    """Speed of every coast over 4 ms, and the law with the mean numbers."""
    longest = max(float(p.t[-1]) for p in pieces)
    grid = np.linspace(0.0, longest, 200)
    measured = []
    for p in pieces:
        step = max(round(0.004 / max(float(np.median(np.diff(p.t))), 1e-6)), 1)
        speed = (p.theta[2 * step :] - p.theta[: -2 * step]) / (p.t[2 * step :] - p.t[: -2 * step]) / RPM
        measured.append(np.interp(grid, p.t[step:-step], speed, left=np.nan, right=np.nan))
    omega_0, a = float(np.mean([c.omega_0 for c in coasts])), float(np.mean([c.a for c in coasts]))
    decay = np.exp(-b * grid)
    law = omega_0 * decay - a * (-np.expm1(-b * grid) / b if b > 0 else grid)
    found.curve(coast__t=grid, coast__speed_rpm=np.array(measured), coast__law_rpm=np.maximum(law, 0.0) / RPM)
