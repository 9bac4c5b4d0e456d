"""What two angles that do not go in the declared ratio are taken for: another unit, sign or side of the gear."""

from __future__ import annotations

from typing import Final

from rig.analysis.motion.degrees import DEGREES

ALIKE: Final = 0.05  # relative, of what a mistake makes: ratios that were declared a little off are told all the same
UNIT: Final = 1.5  # a ratio so near 1 is the same with both sides taken for each other


def mistaken(ratio: float, turns: float) -> str:
    """Why the motor seems to turn `turns` times to one turn of the load, where `ratio` is declared: a clause; "" where
    no usual mistake makes that."""
    if not turns:
        return ""
    if turns < 0:
        return "one of the angles has the other sign"
    if abs(turns * ratio - 1.0) < ALIKE and not 1 / UNIT < ratio < UNIT:
        return "θ_m and θ_l seem to be taken for each other: expected the motor's angle in theta_m"
    for factor, words in ((1 / DEGREES, "θ_l seems to be in degrees"), (DEGREES, "θ_m seems to be in degrees")):
        if abs(turns / ratio / factor - 1.0) < ALIKE:
            return f"{words}, expected rad"
    return ""
