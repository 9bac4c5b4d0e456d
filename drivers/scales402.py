"""Whether the numbers of a CiA 402 drive mean what the bench file says: scales are where real rigs lie      [cia402]"""

from __future__ import annotations

import math

from drivers.node import Node
from drivers.profile402 import counts_position
from drivers.wiring import Place
from rig.core.errors import NotReady

MILLI = 1e-3  # N·m, one digit of 6076h by the standard; some makers count in µN·m
TOLERANCE = 0.02  # what differs by more is another scale, not rounding


def compare_scales(node: Node, place: Place) -> None:
    """Read 6076h, 6075h, 608Fh, 60A8h and 6091h, as far as they are there. Raises NotReady with both numbers."""
    _torque(node, place)
    increments, turns = (node.sdo.read_uint(0x608F, sub, default=0) for sub in (1, 2))
    if increments > 1 and turns and abs(increments / turns - place.counts_per_turn) > 0.5:
        raise NotReady(
            f"{node.who} counts {increments / turns:g} per turn (608Fh), motor.counts_per_turn in the bench file is "
            f"{place.counts_per_turn}"
        )
    unit = node.sdo.read_uint(0x60A8, default=0)
    if not counts_position(unit):
        raise NotReady(f"{node.who} tells positions in another unit (60A8h = {unit:08X}h), expected increments")
    motor, shaft = (node.sdo.read_uint(0x6091, sub, default=1) for sub in (1, 2))
    if motor != shaft:
        raise NotReady(f"{node.who} has a gear of {motor}:{shaft} of its own (6091h), expected 1:1")


def _torque(node: Node, place: Place) -> None:
    told, trusted = node.sdo.read_uint(0x6076, default=0), place.torque_rated
    if not told:
        node.remarks.append(f"{node.who} tells no rated torque (6076h): {trusted:g} N·m is trusted")
        return
    rated = told * place.options.get("rated_step", MILLI)
    if abs(rated / trusted - 1) > TOLERANCE:
        raise NotReady(
            f"{node.who} says its rated torque is {rated:g} N·m (6076h), motor.torque_rated in the bench file is "
            f"{trusted:g} N·m: every torque would be off by a factor of {rated / trusted:.4g}"
            + _other_step(trusted / told, place)
        )
    current = 1e-3 * node.sdo.read_uint(0x6075, default=0)  # A
    declared = place.options.get("torque_constant")
    if current and declared and abs(rated / current / declared - 1) > TOLERANCE:
        raise NotReady(
            f"{node.who} makes {rated / current:.4g} N·m of an ampere (6076h over 6075h), "
            f"devices.drive.torque_constant in the bench file is {declared:g} N·m/A: off by a factor of "
            f"{rated / current / declared:.3g}, "
            "which is 1.41 where peak and effective values are mixed up"
        )
    if round(1e3 * current) == told:
        node.remarks.append(
            f"{node.who} holds {told} both as rated torque (6076h, mN·m) and as rated current (6075h, mA): has anybody "
            "entered the motor's data? Its torques are per mille of that"
        )


def _other_step(step: float, place: Place) -> str:
    """What to write where the two differ by a power of ten, as milli and micro do."""
    tens = round(math.log10(step))
    if abs(step / 10.0**tens - 1) > TOLERANCE:
        return ""
    if tens == 0:  # no drive counts in whole newton metres: the file's number is the drive's own
        meant = place.torque_rated * MILLI
        return f"; the file's number is in N·m: {place.torque_rated:g} mN·m would be torque_rated = {meant:g}"
    return f"; where its manual says that 6076h counts in steps of 1e{tens} N·m: {place.where}.rated_step = 1e{tens}"
