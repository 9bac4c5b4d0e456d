"""Whose order it is: both angles are nearly one, and a whole order of the output is an order of the motor as well."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.joined import Rest

WHOLE_ORDER: Final = 0.05  # how near a whole number: chance is there once in ten times


def of_the_output(found: Home, r: Rest) -> Home:
    """An order of the motor that is none of its own, but a whole one of the output's turn, and no lobe of the wave
    generator seen from the flexspline: the teeth of something on the output, which are no more than the gear's own
    twice over. What a torque sensor before the output does not see is on the motor: a belt goes round less than once a
    turn. What it does see, less than once a turn of the motor, goes by the way of the output, whole order or not."""
    ratio = ratio_of(r)
    if found.coordinate != "motor_angle" or not found.order or not ratio or (found.channel == "M" and r.sensed):
        return found
    own, whole, lobes = found.order, found.order * ratio, found.order * ratio / (ratio + 1)
    off = [abs(x - round(x)) for x in (own, whole, lobes)]
    few = abs(whole) < 2 * 2 * (abs(ratio) + 1) + WHOLE_ORDER
    plain = off[1] < WHOLE_ORDER and off[0] > WHOLE_ORDER / 2 and off[2] > WHOLE_ORDER / 2
    if few and plain and not every_second_turn(whole, ratio):
        return replace(found, coordinate="load_angle", order=float(round(whole)))
    if abs(own) < 1 - WHOLE_ORDER and found.channel == "L" and r.sensed and not every_second_turn(whole, ratio):
        return replace(found, coordinate="load_angle", order=whole)
    return found


def every_second_turn(order: float, ratio: float) -> bool:
    """Whether an order of the output comes back with two turns of the motor: of a hundred whole orders one or two do by
    chance, and whatever takes two turns of the motor to come round does always."""
    return abs(order - round(order)) < WHOLE_ORDER and 2 * round(order) % max(round(abs(ratio)), 1) == 0


def ratio_of(r: Rest) -> float:
    """Turns of the motor to one of the output; 0 where the output's angle is not known or never changes."""
    load, motor = r.at["load_angle"], r.at["motor_angle"]
    known = np.isfinite(load) & np.isfinite(motor)
    if not known.any() or np.ptp(load[known]) == 0:
        return 0.0
    return float(np.polyfit(load[known], motor[known], 1)[0])
