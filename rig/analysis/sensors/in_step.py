"""Rows that keep step with an encoder's counts: rounding then follows the angle and looks like kinematic error."""

from __future__ import annotations

from rig.analysis.motion.declared import declared
from rig.analysis.motion.source import Motion, Source

IN_STEP = 0.002  # of the counts a row: closer to a whole number, and rounding keeps step with the rows for a turn


def in_step(run: Source, motion: Motion, speed_rpm: float) -> str:
    """Says so where an encoder advances a whole number of counts from row to row: its rounding does not average out."""
    encoders = run.manifest.get("encoders") or {}
    row = 0.0 if motion.t is None else float(motion.t[-1] - motion.t[0]) / (motion.t.size - 1)
    for side, key, share in (("motor", "motor_counts_per_rev", 1.0), ("load", "load_counts_per_rev", motion.ratio)):
        counts = declared(encoders, key)
        advance = 0.0 if counts is None else counts / share * speed_rpm / 60.0 * row
        if advance > 0.5 and abs(advance - round(advance)) < IN_STEP * advance:
            return (
                f"At {speed_rpm:.4g} rpm the {side} encoder advances {advance:.3f} counts a row, nearly a whole "
                "number: its rounding follows the angle and does not average out; 1 % more or less speed cures it."
            )
    return ""
