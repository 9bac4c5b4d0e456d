"""Whole turns of the output in one direction: transmission accuracy as makers define it, and close lines told apart."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.collected import Findings
from rig.analysis.findings.intervals import amplitude_interval
from rig.analysis.findings.result import Array, Estimate, Part
from rig.analysis.motion.source import Motion, Source
from rig.analysis.motion.strokes import Stroke, find_strokes
from rig.analysis.orders.lines import Line, fit_lines
from rig.analysis.sensors.in_step import in_step
from rig.analysis.turning.accuracy import Accuracy, accuracy
from rig.core.quantiles import Z95
from rig.model.fourier import PAPER_ORDERS

PAIRS = (1, 2, 4)  # orders of the wave generator whose neighbour in the other part's frame is looked for
WHERE = {  # what a line may come from; k is of the output, n of the wave generator
    "output": "output, load encoder or its mounting",
    "generator": "wave generator against the fixed toothed part",
    "other": "wave generator against the turning toothed part",
}


def add_full_turn(found: Findings, run: Source, motion: Motion) -> None:
    """Add accuracy and lines of the longest stroke, where it holds a whole turn of the output."""
    strokes = [] if motion.theta_l is None else find_strokes(motion)
    stroke = max(strokes, key=lambda s: s.revolutions, default=None)
    turns = 0 if stroke is None else int(stroke.revolutions // motion.ratio)
    if stroke is None or turns < 1:
        longest = 0 if stroke is None else stroke.revolutions
        found.cannot.append(
            f"Transmission accuracy needs {motion.ratio:g} turns of the wave generator in one direction, the longest "
            f"stroke has {longest}."
        )
        return
    speed_rpm = abs(motion.speed_rpm(int(stroke.edges[0]), int(stroke.edges[-1])))
    if locked := in_step(run, motion, speed_rpm):
        found.cannot.append(locked)
    theta, error = _whole_turns(motion, stroke, turns)
    result = accuracy(theta, error, motion.ratio, turns)
    _accuracy(found, result, stroke, turns)
    output = str((run.manifest.get("gear") or {}).get("output", ""))
    _lines(found, theta, result.levelled, motion.ratio, output, turns)


def _whole_turns(motion: Motion, stroke: Stroke, turns: int) -> tuple[Array, Array]:
    """Motor angle [rad] and θ̃ [arcsec] of exactly `turns` turns of the output, from the stroke's first turn on."""
    first = int(stroke.edges[0])
    way = stroke.direction * (motion.theta_m[first : stroke.stop] - motion.theta_m[first])
    stop = first + int(np.searchsorted(np.maximum.accumulate(way), 2.0 * np.pi * motion.ratio * turns))
    return motion.theta_m[first:stop], motion.error_arcsec(first, stop)


def _accuracy(found: Findings, result: Accuracy, stroke: Stroke, turns: int) -> None:
    way = "forward" if stroke.direction > 0 else "reverse"
    how = (
        f"Greatest less least θ̃ over one turn of the output, {way} only, as makers define it, "
        + (f"of the mean of {turns} turns" if turns > 1 else "one turn")
        + f"; what repeats with the gear: the lines that stand out of the noise of {result.bins} pieces a turn of the "
        f"wave generator, whose noise gives the interval (with it the curve spans {result.recorded:.4g} arcsec)"
        + ("; a steady drift between the turns is taken off." if turns > 1 else "; drift with time is in it.")
    )
    ci95 = (result.low, result.high)
    label = f"Transmission accuracy over one output turn, {way}"
    noise = Part(
        "noise of the pieces of a turn",
        (result.high - result.low) / 2,
        "take more turns of the output (--with turns=3)",
    )
    found.estimates.append(Estimate("transmission_accuracy", label, result.value, "arcsec", ci95, how, (noise,)))
    found.curve(
        turn__theta_l_deg=result.theta_l_deg,
        turn__error=result.curve,
        turn__accuracy=np.array([result.value, result.low, result.high]),
    )
    paper = next((e for e in found.estimates if e.name == "kinematic_error_peak_to_peak"), None)
    if paper is not None:
        found.sentence = (
            f"Transmission accuracy {result.value:.1f} arcsec ({result.value / 60:.2f} arcmin) over one output turn, "
            f"{way}, 95 % interval {result.low:.1f} to {result.high:.1f}; that is not the paper's peak to peak per "
            f"turn of the wave generator, averaged over them: {paper.value:.1f} arcsec. {found.sentence}"
        )
    if turns < 2:
        found.cannot.append(
            "One turn of the output in one direction: drift with time looks like an error once per output turn; two "
            "turns tell them apart."
        )


def output_orders(ratio: float, output: str) -> list[tuple[float, str]]:
    """(order per motor turn, where it may come from): the lines a full turn is run for.

    With the flexspline as output an error fixed to it is met at n·(1 + 1/N), with the circular spline at n·(1 − 1/N).
    """
    shift = -1.0 / ratio if output == "circular_spline" else 1.0 / ratio
    found = [(k / ratio, WHERE["output"]) for k in (1, 2)]
    for n in PAIRS:
        found += [(float(n), WHERE["generator"]), (n * (1.0 + shift), WHERE["other"])]
    return found


def _lines(found: Findings, theta: Array, error: Array, ratio: float, output: str, turns: int) -> None:
    """Amplitudes of the close lines, fitted together with the other whole orders, so that none leaks into another."""
    wanted = output_orders(ratio, output)
    others = [float(n) for n in range(1, PAPER_ORDERS + 1) if n not in PAIRS]
    lines = fit_lines(theta, error, [order for order, _ in wanted] + others)[: len(wanted)]
    rows = [_row(line, ratio, where) for line, (_, where) in zip(lines, wanted, strict=True)]
    found.tables["lines_of_the_turn"] = rows
    for row in rows:
        order = float(row["order"])
        how = (
            f"Least squares over {turns} whole output {'turn' if turns == 1 else 'turns'} with all whole orders to "
            f"{PAPER_ORDERS}; a line is {1.0 / (turns * ratio):.3g} orders wide; interval from the noise around it. It "
            f"may come from: {row['source']}."
        )
        state = "" if float(row["lo"]) > 0 else "Not told from zero, only the upper end is a result. "
        ci95 = (float(row["lo"]), float(row["hi"]))
        found.estimates.append(
            Estimate(f"line_{order:g}", f"Line at order {order:g}", float(row["arcsec"]), "arcsec", ci95, state + how)
        )
    found.curve(
        turn__order=np.array([row["order"] for row in rows], float),
        turn__amplitude=np.array([row["arcsec"] for row in rows], float),
        turn__low=np.array([row["lo"] for row in rows], float),
        turn__high=np.array([row["hi"] for row in rows], float),
    )


def _row(line: Line, ratio: float, where: str) -> dict[str, float | str]:
    value, low, high = amplitude_interval(line.amplitude, line.u, Z95)
    return {
        "order": round(line.order, 6),
        "per_output_turn": round(line.order * ratio, 4),
        "arcsec": value,
        "lo": low,
        "hi": high,
        "phase_deg": float(np.degrees(line.phase)) if low > 0 else float("nan"),
        "resolution": line.resolution,
        "source": where,
    }
