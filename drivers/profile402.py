"""What the words and numbers of a CiA 402 drive mean: controlwords, states, units      [cia402]"""

from __future__ import annotations

import struct

from rig.core.units import TURN

OPERATES = 1 << 2  # of the statusword: also while it brakes, in quick stop or because of a fault
DISABLE, SHUTDOWN, SWITCH_ON, ENABLE, RESET = 0x00, 0x06, 0x07, 0x0F, 0x80  # controlwords
REVOLUTION, INCREMENT, SECOND, MINUTE = 0xB4, 0xB5, 0x03, 0x47  # notation indices of units      [cia303]


def state_of(statusword: int) -> str:
    """The state a statusword tells      [cia402, 6.3]"""
    if statusword & 0x4F == 0x40:
        return "switch on disabled"
    match statusword & 0x6F:
        case 0x21:
            return "ready to switch on"
        case 0x23:
            return "switched on"
        case 0x27:
            return "operation enabled"
        case 0x07:
            return "quick stop active"
    match statusword & 0x4F:
        case 0x0F:
            return "fault reaction active"
        case 0x08:
            return "fault"
        case 0x00:
            return "not ready to switch on"
    return f"no state of the standard (statusword {statusword:04X}h)"


def speed_unit(code: int, counts_per_turn: float) -> float | None:
    """How many of the unit 60A9h names are 1 rad/s; None when it is no speed this program knows.

    Prefix i8, numerator u8, denominator u8, 0: 00B44700h are revolutions per minute, 00B50300h increments per second.
    """
    prefix, numerator, denominator = struct.unpack("<bBB", bytes((code >> n) & 0xFF for n in (24, 16, 8)))
    angles = {REVOLUTION: 1.0 / TURN, INCREMENT: counts_per_turn / TURN}
    times = {SECOND: 1.0, MINUTE: 60.0}
    if numerator not in angles or denominator not in times:
        return None
    return float(angles[numerator] * times[denominator] * 10.0**-prefix)


def counts_position(code: int) -> bool:
    """Whether 60A8h, 0 where it is absent, says that positions are in increments of the encoder."""
    return code in (0, INCREMENT << 16)


def signed32(counts: int) -> int:
    """As a 32-bit register holds it."""
    return (counts + (1 << 31)) % (1 << 32) - (1 << 31)
