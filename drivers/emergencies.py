"""What the error codes of a CANopen node mean, in words      [cia301, 7.2.7]"""

from __future__ import annotations

EMERGENCIES = {
    0x1000: "generic error",
    0x2000: "current",
    0x3000: "voltage",
    0x4000: "temperature",
    0x5000: "device hardware",
    0x6000: "device software",
    0x7000: "additional modules",
    0x8000: "monitoring",
    0x8100: "communication",
    0x8110: "CAN overrun, frames lost",
    0x8120: "CAN in error-passive mode",
    0x8130: "heartbeat or life guarding of this host was missed",
    0x8140: "recovered from bus-off",
    0x8200: "protocol error",
    0x8210: "PDO not processed, wrong length",
    0x8250: "RPDO timeout: the commands stayed away",
    0x8400: "speed control",
    0x8500: "position control",
    0x8600: "position control",
    0x8611: "following error",
    0x9000: "external error",
    0xFF00: "device specific",
}


def emergency_text(code: int) -> str:
    """What an error code means, by the finest class the standard names      [cia301, 7.2.7]"""
    for mask in (0xFFFF, 0xFFF0, 0xFF00, 0xF000):
        if code & mask in EMERGENCIES:
            return EMERGENCIES[code & mask]
    return "a code of the maker's"
