"""CANSimple, the frames of ODrive motor controllers: identifier node << 5 | command, little-endian      [odrive]

An axis sends its heartbeat and what it was told to send of its own accord; anything else is asked for by a remote
frame of the same identifier. Angles are in turns, torques in N·m.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

PROTOCOL = "CANSimple"
VERSION, HEARTBEAT, SET_STATE, ESTIMATES = 0x00, 0x01, 0x07, 0x09  # commands
SET_MODE, SET_TORQUE, SET_LIMITS, IQ, CLEAR, TORQUES = 0x0B, 0x0E, 0x0F, 0x14, 0x18, 0x1C
IDLE, CLOSED_LOOP = 1, 8  # axis states
TORQUE_CONTROL, PASSTHROUGH = 1, 1  # control and input mode
STATES = {
    0: "undefined",
    1: "idle",
    2: "startup sequence",
    3: "full calibration",
    4: "motor calibration",
    5: "sensorless control",
    6: "encoder index search",
    7: "encoder offset calibration",
    8: "closed-loop control",
    9: "lock-in spin",
    10: "encoder direction search",
    11: "homing",
    12: "hall polarity calibration",
    13: "hall phase calibration",
    14: "anticogging calibration",
}
PRO_WATCHDOG, OLD_WATCHDOG = 1 << 24, 1 << 11  # "watchdog expired", by generation of the firmware
PRO_ERRORS = {  # bits from firmware 0.6 on
    0: "initialising",
    1: "system level",
    2: "timing",
    3: "no estimate of position or speed",
    4: "bad configuration",
    5: "gate driver fault",
    6: "no input",
    8: "DC bus over-voltage",
    9: "DC bus under-voltage",
    10: "DC bus over-current",
    11: "too much regenerated current",
    12: "current limit violated",
    13: "motor too hot",
    14: "inverter too hot",
    15: "velocity limit violated",
    16: "position limit violated",
    24: "watchdog expired: the commands stayed away",
    25: "stop requested",
    26: "spinout detected",
    27: "brake resistor disarmed",
    28: "thermistor disconnected",
    30: "calibration",
}
OLD_ERRORS = {  # bits up to firmware 0.5
    0: "invalid state",
    6: "motor failed",
    7: "sensorless estimator failed",
    8: "encoder failed",
    9: "controller failed",
    11: "watchdog expired: the commands stayed away",
    12: "lower end stop pressed",
    13: "upper end stop pressed",
    14: "stop requested",
    17: "homing without an end stop",
    18: "too hot",
    19: "position unknown",
}


class Heartbeat(NamedTuple):
    """What an axis says of its own accord."""

    error: int  # bits
    state: int


class Version(NamedTuple):
    """Of an axis from firmware 0.6 on; older ones do not say."""

    hardware: tuple[int, int, int]
    firmware: tuple[int, int, int]


def identifier(node: int, command: int) -> int:
    """11 bits: six of the node, five of the command."""
    return node << 5 | command


def decode_heartbeat(data: bytes) -> Heartbeat:
    """Error u32, state u8; what follows differs between firmwares."""
    return Heartbeat(*struct.unpack_from("<IB", data))


def decode_version(data: bytes) -> Version:
    """Protocol u8, hardware 3 × u8, firmware 3 × u8, unreleased u8."""
    _, *numbers = struct.unpack("<8B", data)
    return Version((numbers[0], numbers[1], numbers[2]), (numbers[3], numbers[4], numbers[5]))


def decode_pair(data: bytes) -> tuple[float, float]:
    """Two f32: position [turns] and speed [turns/s]; torque, or current, wanted and measured [N·m, A]."""
    first, second = struct.unpack("<ff", data)
    return first, second


def encode_mode(control: int, inputs: int) -> bytes:
    """Control mode u32, input mode u32."""
    return struct.pack("<II", control, inputs)


def encode_state(state: int) -> bytes:
    """Axis state wanted, u32."""
    return struct.pack("<I", state)


def encode_torque(tau: float) -> bytes:
    """f32 in N·m."""
    return struct.pack("<f", tau)


def encode_limits(turns_per_second: float, amperes: float) -> bytes:
    """Speed limit f32 [turns/s], current limit f32 [A]."""
    return struct.pack("<ff", turns_per_second, amperes)


def error_text(error: int, names: dict[int, str]) -> str:
    """The bits of an error in words."""
    words = [names.get(bit, f"bit {bit}") for bit in range(32) if error >> bit & 1]
    return ", ".join(words)
