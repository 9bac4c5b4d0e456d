"""The motor's speed over the longest stroke: its mean, its drift, its ripple."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.collected import Findings
from rig.analysis.findings.intervals import t95
from rig.analysis.motion.source import Motion
from rig.analysis.motion.speed import motor_speed
from rig.analysis.motion.strokes import Stroke
from rig.analysis.sensors.standstill import floor_of
from rig.core.quantiles import Z95
from rig.core.units import RPM

JITTER = 0.01  # of the speed window: more makes a ripple of its own


def add_speed_figures(found: Findings, motion: Motion, strokes: list[Stroke]) -> None:
    """Drift and ripple of the speed over the longest stroke."""
    if motion.t is None:
        found.cannot.append("No usable time column: speeds cannot be had.")
        return
    s = max(strokes, key=lambda s: s.revolutions)
    edges = s.edges
    turns = np.diff(motion.theta_m[edges]) / np.diff(motion.t[edges]) / RPM
    if not any(e.name == "mean_speed" for e in found.estimates):
        half = Z95 * float(turns.std()) / np.sqrt(turns.size)
        found.figure(
            "mean_speed", "Mean motor speed", float(turns.mean()), "rpm", half, "Turn by turn over the longest stroke."
        )
    if turns.size >= 8:
        middle = 0.5 * (motion.t[edges][1:] + motion.t[edges][:-1])
        (slope, _), cov = np.polyfit(middle - middle[0], turns, 1, cov=True)
        span = float(middle[-1] - middle[0])
        found.figure(
            "speed_drift",
            "Speed change over the stroke",
            float(slope) * span,
            "rpm",
            t95(turns.size - 2) * float(np.sqrt(cov[0, 0])) * span,
            "Line through the speeds of the turns, end to end; interval from their scatter about it.",
        )
    fine = motor_speed(motion.t[s.start : s.stop], motion.theta_m[s.start : s.stop], step=0.004)
    jitter = float(np.std(np.diff(motion.t[s.start : s.stop])))
    if jitter > JITTER * fine.window:
        found.cannot.append(f"Speed ripple: the rows' times jitter by {1000 * jitter:.2g} ms, which looks like ripple.")
    elif fine.omega.size > 16:
        speed = fine.omega / RPM
        how = (
            f"1 σ of the speed over {1000 * fine.window:.0f} ms windows: ripple with the angle, wander, count noise; "
            "interval from the scatter of pieces."
        )
        found.figure("speed_ripple", "Speed ripple", float(np.std(speed)), "rpm", floor_of(speed, None).u_rms, how)
