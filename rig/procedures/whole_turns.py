"""Whether the strokes of a triangle are long enough for a figure of the kinematic error, to be said before a run."""

from __future__ import annotations

from rig.control.profile import Triangle
from rig.core.units import TURN

CUT = 0.5  # motor turns that the analysis leaves out at a reversal, and where the motor starts from rest
NEARLY = 0.02  # turns that may be wanting
INTERVAL = "an interval takes two of one direction: expected a larger amplitude_deg or more cycles"


def whole_turns(wave: Triangle) -> tuple[int, int]:
    """Motor turns, forward and reverse, that are left whole at most, however well the motor follows."""
    amplitude = wave.amplitude / TURN
    strokes = [amplitude, *[2 * amplitude] * (round(2 * wave.cycles) - 1), amplitude]
    left = [max(0, int(stroke - 2 * CUT + NEARLY)) for stroke in strokes]
    left[-1] = max(0, int(amplitude - CUT + NEARLY))  # it ends at rest and not at a reversal
    return sum(left[::2]), sum(left[1::2])


def too_short(wave: Triangle) -> list[str]:
    """A sentence where no figure can be had, or none with an interval; nothing otherwise."""
    forward, reverse = whole_turns(wave)
    if max(forward, reverse) > 1:
        return []
    if forward or reverse:
        return [
            f"the kinematic error will have no interval: {forward} forward and {reverse} reverse motor turns are left "
            f"at most once half a turn is cut at either reversal, and {INTERVAL}"
        ]
    longest, least = (2, 360) if wave.cycles >= 1 else (1, 540)
    return [
        f"no kinematic error can be had: of strokes of {longest * wave.amplitude / TURN:.2f} motor turns no whole one "
        f"is left once half a turn is cut at either reversal; expected amplitude_deg of {least} deg or more"
    ]
