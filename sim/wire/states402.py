"""The state machine of a CiA 402 drive as a table: which command leads where      [cia402, Figure "State machine"]"""

from __future__ import annotations

from enum import IntEnum


class DriveState(IntEnum):
    """The states; the value is what the statusword says under the mask 0x6F (0x4F where bit 5 does not matter)."""

    NOT_READY_TO_SWITCH_ON = 0x00
    SWITCH_ON_DISABLED = 0x40
    READY_TO_SWITCH_ON = 0x21
    SWITCHED_ON = 0x23
    OPERATION_ENABLED = 0x27
    QUICK_STOP_ACTIVE = 0x07
    FAULT_REACTION_ACTIVE = 0x0F
    FAULT = 0x08


class Command(IntEnum):
    """What a controlword asks for, but for the fault reset, which is an edge."""

    DISABLE_VOLTAGE = 0
    QUICK_STOP = 1
    SHUTDOWN = 2
    SWITCH_ON = 3
    ENABLE_OPERATION = 4


FAULT_RESET = 0x80  # bit 7 of the controlword, rising edge
POWERED = {DriveState.SWITCHED_ON, DriveState.OPERATION_ENABLED, DriveState.QUICK_STOP_ACTIVE}

_S, _C = DriveState, Command
TRANSITIONS: dict[DriveState, dict[Command, DriveState]] = {
    _S.SWITCH_ON_DISABLED: {_C.SHUTDOWN: _S.READY_TO_SWITCH_ON},  # 2
    _S.READY_TO_SWITCH_ON: {
        _C.SWITCH_ON: _S.SWITCHED_ON,  # 3
        _C.ENABLE_OPERATION: _S.OPERATION_ENABLED,  # 3 and 4 at once
        _C.QUICK_STOP: _S.SWITCH_ON_DISABLED,  # 7
        _C.DISABLE_VOLTAGE: _S.SWITCH_ON_DISABLED,  # 7
    },
    _S.SWITCHED_ON: {
        _C.ENABLE_OPERATION: _S.OPERATION_ENABLED,  # 4
        _C.SHUTDOWN: _S.READY_TO_SWITCH_ON,  # 6
        _C.QUICK_STOP: _S.SWITCH_ON_DISABLED,  # 10
        _C.DISABLE_VOLTAGE: _S.SWITCH_ON_DISABLED,  # 10
    },
    _S.OPERATION_ENABLED: {
        _C.SWITCH_ON: _S.SWITCHED_ON,  # 5
        _C.SHUTDOWN: _S.READY_TO_SWITCH_ON,  # 8
        _C.DISABLE_VOLTAGE: _S.SWITCH_ON_DISABLED,  # 9
        _C.QUICK_STOP: _S.QUICK_STOP_ACTIVE,  # 11
    },
    _S.QUICK_STOP_ACTIVE: {
        _C.DISABLE_VOLTAGE: _S.SWITCH_ON_DISABLED,  # 12
        _C.ENABLE_OPERATION: _S.OPERATION_ENABLED,  # 16, where the quick stop option lets it
    },
}


def command(controlword: int) -> Command:
    """The command in a controlword; bits that do not matter to it are not looked at      [cia402, controlword]"""
    if not controlword & 0x02:
        return Command.DISABLE_VOLTAGE
    if not controlword & 0x04:
        return Command.QUICK_STOP
    if not controlword & 0x01:
        return Command.SHUTDOWN
    return Command.ENABLE_OPERATION if controlword & 0x08 else Command.SWITCH_ON
