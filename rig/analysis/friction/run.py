"""A friction run: Coulomb and viscous parts of both sides, where friction falls with speed, breakaway, warming up."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rig.analysis.findings.collected import Findings, pm
from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Array, Check
from rig.analysis.identify.friction import MotorFriction, load_friction, motor_friction, total_friction
from rig.analysis.identify.means import Mean, Sides, mean_of, variances
from rig.analysis.identify.recording import Recording, plateaus, recording
from rig.analysis.identify.slow import slow_series
from rig.analysis.identify.solve import Solved
from rig.analysis.kinematic_error.ratio import disagreement
from rig.analysis.motion.degrees import turning_of
from rig.analysis.motion.source import Motion, Source
from rig.analysis.turning.units import unlikely_torque
from rig.core.units import RPM
from rig.model.fourier import PAPER_ORDERS, FourierSeries

WARMED = 0.03  # of friction, rising against falling: more and the lubricant changed during the run
HELD = 0.1  # of a speed: a plateau farther off is another one
SAME = 0.02  # of a speed: plateaus closer than this are the same speed
RAMP = 0.2  # of the largest peak: less is the brake holding the rig at the end
STILL = 1e-4  # N·m of asked torque: less is none


def add_friction(found: Findings, run: Source, motion: Motion) -> None:
    """Add the figures of a run over several speeds. Says what is missing instead where it is."""
    if wrong := _in_another_unit(run, motion):
        found.checks.append(Check("unit", False, wrong))
        found.sentence = "No friction was computed."
        found.reject(wrong)
        return
    for doubtful in unlikely_torque(run):
        found.cannot.append(doubtful)
        found.inconclusive = doubtful
    _breakaway(found, run, motion)
    rec = recording(run)
    level = [] if rec is None else plateaus(rec)
    if rec is None or len(level) < 4:
        found.sentence = f"Friction: {len(level)} stretches of constant speed were found, expected at least 4."
        found.cannot.append(found.sentence)
        found.inconclusive = found.sentence
        return
    series = _series(rec)
    means = [mean_of(p, series, Sides()) for p in level]
    motor, load, total = motor_friction(means), load_friction(means, rec.ratio), total_friction(means)
    if total is not None:
        _lines(found, total, "", "all the rig, seen at the motor", "the drive's torque")
    if motor is not None:
        _lines(found, motor, "motor_", "motor side", "the drive's torque less the shaft torque's share")
        found.cannot.append(
            "B_m and B_ml: the drag on the motor's side is their sum; with the wave generator out it is B_m alone."
        )
    if load is not None:
        s, how = load.solved, f"Means of the torque sensor over {len(load.rows)} plateaus: line against speed."
        found.figure("load_coulomb", "Coulomb friction, load side", s.coefficients[1], "N·m", s.half(1), how)
        found.figure("load_viscous", "Viscous drag, load side", s.coefficients[0], "N·m·s/rad", s.half(0), how)
        if load.zero is not None:
            found.figure("sensor_zero", "Torque sensor, zero", s.coefficients[2], "N·m", s.half(2), how)
    else:
        found.cannot.append("Load side: without a torque sensor its share of the friction cannot be had.")
    best = motor or total
    _unsteady(found, run, means)
    _warming(found, means)
    _tables(found, means, best)
    found.sentence = _headline(total)


def _in_another_unit(run: Source, motion: Motion) -> str:
    """That the angles are not of one gear in rad: drags go by a speed; "" where nothing says so."""
    if wrong := disagreement(motion):
        return wrong
    unit = turning_of(run, motion).in_degrees
    return f"The unit of the angles looks wrong: {unit}." if unit else ""


def _series(rec: Recording) -> FourierSeries:
    """θ̃_p from the run's own slow plateaus: it levers the shaft torque at the motor. Zeros where there are none."""
    slow = slow_series(rec, PAPER_ORDERS)
    c = np.zeros(2 * PAPER_ORDERS) if slow is None else slow.coefficients
    return FourierSeries(tuple(map(float, c[:PAPER_ORDERS])), tuple(map(float, c[PAPER_ORDERS:])))


def _lines(found: Findings, f: MotorFriction, prefix: str, where: str, of: str) -> None:
    """Coulomb and viscous part, and the fall where it was seen."""
    s = f.solved
    how = f"Means of {of} over whole turns of {len(f.rows)} plateaus: line against speed, both directions."
    found.figure(f"{prefix}coulomb", f"Coulomb friction, {where}", s.coefficients[1], "N·m", s.half(1), how)
    found.figure(f"{prefix}viscous", f"Viscous drag, {where}", s.coefficients[0], "N·m·s/rad", s.half(0), how)
    found.cannot += [words for words in (f.doubt, f.bend) if words]
    if f.fall is not None:
        fell = f"{how} Falling part fall·exp(−(ω/ω_s)²) with the speed that fits best."
        label = f"Friction above Coulomb at standstill, {where}"
        found.figure(f"{prefix}fall", label, s.coefficients[f.fall], "N·m", s.half(f.fall), fell)
        found.exact(f"{prefix}stribeck_speed", f"Speed of the fall, {where}", f.omega_s / RPM, "rpm", fell)


def _breakaway(found: Findings, run: Source, motion: Motion) -> None:
    """Peak torque of every open-loop ramp from rest: rows without reference in which a torque was asked."""
    asked, reference = motion.pick(run.column("tau_ask")), motion.pick(run.column("theta_ref"))
    if asked is None or reference is None:
        return
    on = np.isnan(reference) & (np.abs(asked) > STILL)
    edges = np.flatnonzero(np.diff(np.concatenate(([0], on.astype(np.int8), [0]))))
    peaks = [float(asked[a:b][np.argmax(np.abs(asked[a:b]))]) for a, b in zip(edges[::2], edges[1::2], strict=True)]
    size = np.abs(peaks)
    size = size[size > RAMP * np.max(size, initial=0.0)]
    if size.size < 2:
        return
    half = t95(size.size - 1) * float(size.std(ddof=1)) / np.sqrt(size.size)
    how = f"Torque at which the motor had moved along a slow ramp from rest, {size.size} ramps; scatter of the ramps."
    found.figure("breakaway", "Breakaway torque, at the motor", float(size.mean()), "N·m", float(half), how)


def _unsteady(found: Findings, run: Source, means: Sequence[Mean]) -> None:
    """Speeds that were asked for and never held: the motor stuck and slipped there, a mean torque means nothing."""
    asked = run.conditions.get("speeds_rpm")
    if not isinstance(asked, list | tuple):
        return
    held = [abs(m.omega) / RPM for m in means]
    missing = [s for s in asked if isinstance(s, int | float) and not any(abs(h / s - 1.0) < HELD for h in held)]
    if missing:
        words = ", ".join(f"{s:g}" for s in missing)
        found.cannot.append(f"At {words} rpm the motor did not turn evenly (it sticks and slips): those are left out.")


def _warming(found: Findings, means: Sequence[Mean]) -> None:
    """Friction when the speeds rose against when they fell: relative, over the pairs of one signed speed."""
    pairs = []
    for i, m in enumerate(means):
        for other in means[i + 1 :]:
            if abs(other.omega / m.omega - 1.0) < SAME and np.isfinite(m.total):
                pairs.append((m, other))
                break
    if not pairs:
        return
    change = np.array([(b.total - a.total) / a.total for a, b in pairs])
    noise = variances([m.all_sides.pieces for m in means], [m.duration for m in means])
    own = {id(m): v for m, v in zip(means, noise, strict=True)}
    u = np.array([np.sqrt(own[id(a)] + own[id(b)]) / abs(a.total) for a, b in pairs])
    u = np.where(np.isfinite(u) & (u > 0), u, 1.0)
    weight = 1.0 / u**2
    mean = float(np.sum(weight * change) / np.sum(weight))
    spread = float(np.sqrt(np.sum(weight * (change - mean) ** 2) / max(change.size - 1, 1) / np.sum(weight)))
    half = t95(max(change.size - 1, 1)) * max(spread, float(1.0 / np.sqrt(np.sum(weight))))
    how = f"{change.size} pairs of plateaus of one speed, the later against the earlier, by the drive's torque."
    found.figure("friction_drift", "Friction, falling against rising speeds", 100 * mean, "%", 100 * half, how)
    within = abs(mean) - half <= WARMED
    sentence = f"Friction changed by {100 * mean:+.2f} ± {100 * half:.2f} % within the run, limit {100 * WARMED:g} %."
    found.checks.append(Check("warm", within, sentence))


def _tables(found: Findings, means: Sequence[Mean], best: MotorFriction | None) -> None:
    rows: list[dict[str, float | str]] = []
    for m in means:
        row: dict[str, float | str] = {"speed_rpm": m.omega / RPM, "seconds": m.duration, "motor_torque": m.total}
        row |= {"motor_side": m.motor, "load_side": m.load}
        rows.append(row)
    found.tables["plateaus"] = rows
    order = np.argsort([m.omega for m in means])
    omega = np.array([m.omega for m in means])[order]
    found.curve(friction__rpm=omega / RPM, friction__total=np.array([m.total for m in means])[order])
    if best is None:
        return
    s = best.solved
    speeds = np.concatenate(
        (
            -np.geomspace(np.abs(omega).max(), np.abs(omega).min(), 60),
            np.geomspace(np.abs(omega).min(), np.abs(omega).max(), 60),
        )
    )
    found.curve(friction__line_rpm=speeds / RPM, friction__line=curve(best, s, speeds))
    side = np.array([m.motor if np.isfinite(m.motor) else m.total for m in means])[order]
    found.curve(friction__motor=side)


def curve(f: MotorFriction, s: Solved, omega: Array) -> Array:
    """The fitted friction [N·m] at `omega` rad/s of the motor."""
    c = s.coefficients
    torque = c[f.B] * omega + c[f.tau_c] * np.sign(omega)
    if f.offset is not None:
        torque = torque + c[f.offset]
    if f.fall is not None:
        torque = torque + c[f.fall] * np.sign(omega) * np.exp(-((omega / f.omega_s) ** 2))
    return np.asarray(torque)


def _headline(total: MotorFriction | None) -> str:
    if total is None:
        return "Friction: the plateaus have no motor torque, or a single speed: no line could be drawn."
    s = total.solved
    return (
        f"Coulomb friction seen at the motor {pm(float(s.coefficients[1]), s.half(1), 'N·m')}, drag "
        f"{pm(1000 * float(s.coefficients[0]), 1000 * s.half(0), 'mN·m·s/rad')}, {len(total.rows)} plateaus."
    )
