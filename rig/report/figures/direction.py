"""The two directions of motion: how each is drawn, everywhere. Told apart by colour, dash and place in the key."""

from __future__ import annotations

from typing import NamedTuple

from rig.report.palette import LIGHT


class Direction(NamedTuple):
    """One direction of motion as drawn."""

    name: str
    colour: str
    soft: str  # of single revolutions
    dash: object  # line style of means


FORWARD = Direction("forward", LIGHT["forward"], LIGHT["forward-soft"], "solid")
REVERSE = Direction("reverse", LIGHT["reverse"], LIGHT["reverse-soft"], (0, (7, 2.2)))
FIT_DASH = (0, (1.2, 1.8))
