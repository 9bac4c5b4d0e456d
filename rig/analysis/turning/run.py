"""Runs whose motor turns: slow ones give the kinematic error, fast ones what becomes of it at speed."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.collected import Findings
from rig.analysis.findings.intervals import amplitude_interval
from rig.analysis.findings.result import Check, Estimate
from rig.analysis.kinematic_error import words
from rig.analysis.kinematic_error.lobes import may_read_twice, reads_a_part
from rig.analysis.kinematic_error.measure import KinematicError, groups_by_speed, measure
from rig.analysis.kinematic_error.ratio import disagreement, doubt, turns_per_turn
from rig.analysis.kinematic_error.slips import slipped
from rig.analysis.motion.declared import declared
from rig.analysis.motion.degrees import turning_of
from rig.analysis.motion.mistaken import mistaken
from rig.analysis.motion.source import Motion, Source
from rig.analysis.motion.speed import Speed
from rig.analysis.motion.strokes import Stroke, find_strokes
from rig.analysis.sensors.latch_skew_words import add_skew_error
from rig.analysis.smoothness import words as smooth
from rig.analysis.smoothness.measure import Smoothness
from rig.analysis.smoothness.measure import smoothness as smoothness_of
from rig.analysis.turning.spectrum import add_orders
from rig.analysis.turning.speed import add_speed_figures
from rig.analysis.turning.torsion_words import add_torsion
from rig.analysis.turning.units import unlikely_time, unlikely_torque, winds_too_far, wrong_unit
from rig.analysis.turning.weight import other_weight
from rig.core.kinds import Regime, regime_of
from rig.core.units import TURN

NO_LOAD = "The run has no reading of the load angle: kinematic error, torsion and orders of θ̃ cannot be had."


def add_turning(found: Findings, run: Source, motion: Motion, speed: Speed | None, slow: bool) -> None:
    """Everything a turning motor tells. `slow`: the run was meant to give the pure kinematic error, so it is judged."""
    strokes = find_strokes(motion)
    if not strokes:
        span = float(np.ptp(motion.theta_m)) / TURN
        found.sentence = (
            f"The motor made no whole turn in one direction once the reversals are cut (it moved {span:.2f} turns)."
        )
        if why := mistaken(motion.ratio, turns_per_turn(motion)):
            found.sentence = f"{found.sentence[:-1]}; {why}."
        found.cannot.append(found.sentence)
        found.inconclusive = found.sentence
        return
    reference = motion.pick(run.column("theta_ref"))
    wrong = wrong_unit(motion, strokes, reference, run.conditions)
    if not wrong and (unit := turning_of(run, motion).in_degrees):
        wrong = f"The unit of the angles looks wrong: {unit}."
    if wrong:
        found.checks.append(Check("unit", False, wrong))
        found.sentence = "No kinematic error was computed."
        found.reject(wrong)
        return
    found.cannot += unlikely_torque(run)
    if doubtful := unlikely_time(motion):
        found.cannot.append(doubtful)
        found.inconclusive = doubtful
    evenness = _judge_smoothness(found, smoothness_of(motion, strokes, reference, speed)) if slow else ()
    if motion.theta_l is None:
        found.cannot.append(NO_LOAD)
        add_speed_figures(found, motion, strokes)
        found.estimates += evenness
        found.sentence = found.sentence or "The motor turned, theta_l has no reading."
        if slow:  # what the run was taken for cannot be had
            found.inconclusive = found.inconclusive or found.sentence
        return
    _with_load(found, run, motion, strokes, slow, evenness)
    if doubtful:
        found.sentence = f"{doubtful} {found.sentence}"


def _judge_smoothness(found: Findings, smoothness: Smoothness | None) -> tuple[Estimate, ...]:
    """The checks on how evenly the motor turned, by which a run may be rejected. Gives the figures of it."""
    if smoothness is None:
        found.cannot.append(
            "No usable time column: whether the motor stuck or hunted cannot be told; orders are unaffected."
        )
        return ()
    found.checks += smooth.checks(smoothness)
    if not smoothness.passed:
        found.reject(smooth.sentence(smoothness))
    return smooth.estimates(smoothness)


def _with_load(
    found: Findings, run: Source, motion: Motion, strokes: list[Stroke], slow: bool, evenness: tuple[Estimate, ...]
) -> None:
    """What both angles tell: kinematic error, orders, torsion; nothing where they contradict the declared ratio."""
    tau_l = motion.pick(run.column("tau_l"))
    turns = turns_per_turn(motion)
    wrong = disagreement(motion, turns)
    K = declared(run.declared, "K")
    doubtful = "" if wrong else doubt(motion, tau_l, K)
    agree = f"The encoders turn {turns:.5g} to 1, declared {motion.ratio:g}."
    found.checks.append(Check("ratio", not (wrong or doubtful), wrong or doubtful or agree))
    if wrong:
        found.sentence = "No kinematic error was computed."
        found.reject(wrong)
        return
    if unit := winds_too_far(motion, tau_l, K):
        found.cannot.append(unit)
    main = _kinematic_error(found, run, motion, strokes, slow)
    if doubtful:
        found.inconclusive, found.sentence = found.inconclusive or doubtful, f"{doubtful} {found.sentence}"
    add_orders(found, motion, max(main, key=lambda s: s.revolutions))
    if not slow:
        add_speed_figures(found, motion, strokes)
    found.estimates += evenness
    if weight := other_weight(run, strokes, tau_l):
        found.cannot.append(weight)
    if not add_torsion(found, motion, tau_l) and regime_of(run.procedure) is Regime.OTHER:  # the others keep their load
        why = "there is no shaft torque" if tau_l is None else "the shaft torque does not move within a stroke"
        found.cannot.append(f"Stiffness: {why}; a lock test shows it (hdrig run stiffness-lock).")


def _kinematic_error(found: Findings, run: Source, motion: Motion, strokes: list[Stroke], slow: bool) -> list[Stroke]:
    """Add the kinematic error of the speed that matters, and give the strokes that had it."""
    groups = groups_by_speed(motion, strokes)
    most = max(sum(s.revolutions for s in g) for g in groups)
    # the pure error is the slowest speed's; a run at speed is described by the speed it held longest
    worthy = [g for g in groups if sum(s.revolutions for s in g) * 4 >= most]
    main = worthy[0] if slow else max(groups, key=lambda g: sum(s.revolutions for s in g))
    ke = measure(run, motion, main, slow)
    if ke is None:
        found.cannot.append("The rows are too few per motor turn for a single order.")
        found.sentence = "The motor turned too fast for the row rate."
        found.inconclusive = found.sentence
        return main
    words.add_profile(found, ke, slow)
    words.add_series(found, ke, slow)
    words.add_trend(found, ke)
    output = str(run.manifest.get("gear", {}).get("output", ""))
    words.add_limits_of_the_run(found, ke, motion.ratio, output, slow)
    found.sentence = headline(found, ke, slow)
    if short := words.cut_short(found, ke):
        found.inconclusive, found.sentence = short, f"{short} {found.sentence}"
    if part := reads_a_part(ke.profile.amplitude):
        found.checks.append(Check("lobes", False, part))
        found.inconclusive, found.sentence = part, f"{part} {found.sentence}"
    if note := may_read_twice(ke.profile.amplitude):
        found.cannot.append(note)
    if slip := slipped(motion, main, ke.strokes):
        found.checks.append(Check("slips", False, slip))
        found.inconclusive, found.sentence = slip, f"{slip} {found.sentence}"
    add_skew_error(found, run, ke.speed_rpm)
    if slow and not np.isfinite(ke.profile.peak_to_peak()[1][0]):
        found.inconclusive = "Too few revolutions for an interval."
    others = [(g, measure(run, motion, g, slow)) for g in worthy if g is not main]
    if others:
        found.tables["speeds"] = [_speed_row(k) for k in (ke, *(k for _, k in others)) if k is not None]
        found.cannot.append(
            f"The run holds {len(worthy)} speeds; the figures are those of {ke.speed_rpm:.4g} rpm, a table has all."
        )
    return main


def _speed_row(ke: KinematicError) -> dict[str, float | str]:
    value, (low, high) = ke.profile.peak_to_peak()
    order2 = float(ke.profile.amplitude[1]) if ke.profile.terms > 1 else float("nan")
    return {
        "speed_rpm": ke.speed_rpm,
        "revolutions": float(ke.profile.forward + ke.profile.reverse),
        "peak_to_peak_arcsec": value,
        "lo": low,
        "hi": high,
        "order_2_arcsec": order2,
    }


def headline(found: Findings, ke: KinematicError, slow: bool) -> str:
    """One sentence with the figure, its interval, the speed and the number of revolutions."""
    p = ke.profile
    value, (low, high) = p.peak_to_peak()
    what = "Kinematic error" if slow else "θ̃"
    at = f" at {ke.speed_rpm:.4g} rpm" if np.isfinite(ke.speed_rpm) else ""
    text = f"{what} {value:.1f} arcsec ({value / 60:.2f} arcmin) peak to peak{at}, " + (
        f"95 % interval {low:.1f} to {high:.1f}" if np.isfinite(low) else "too few revolutions for an interval"
    )
    text += f", from {p.forward} forward and {p.reverse} reverse revolutions"
    strongest = int(np.argmax(p.amplitude)) + 1
    size = amplitude_interval(float(p.amplitude[strongest - 1]), float(p.u_amplitude[strongest - 1]), p.factor)[0]
    text += f"; order {strongest} is the largest with {size:.2f} arcsec."
    slow_part = ke.trend.peak_to_peak
    if slow_part is not None and slow_part[0] > value:
        text += f" The slow change over the output angle is larger ({slow_part[0]:.0f} arcsec) and not in it."
    return text
