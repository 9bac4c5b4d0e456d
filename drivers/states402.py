"""The state machine of a CiA 402 drive: walked one transition at a time, reset, and confirmed off      [cia402, 6.3]

canopen's own helper is not used: its `reset_from_fault` goes on to OPERATION ENABLED. `hold` sends a controlword with
nothing asked for.
"""

from __future__ import annotations

import contextlib
import struct
from collections.abc import Callable

from drivers.emergencies import emergency_text
from drivers.node import Node
from drivers.pdo import Inputs
from drivers.profile402 import DISABLE, OPERATES, RESET, state_of
from rig.core.clock import is_never
from rig.core.errors import NotReady

STEP_PATIENCE = 1.0  # s for one transition: brakes and precharge take their time
CONFIRM = 0.2  # s for the drive to say that it is off; the frame that takes the torque off has long been sent
BARRED = "switch on disabled"
HELD_OFF = ": safe torque off, a hard-wired stop or a missing supply keeps a drive there; no reset does away with that"
Hold = Callable[[int], object]


def walk(node: Node, hold: Hold, controlword: int, wanted: str) -> None:
    """One transition, to the state `wanted`. Raises NotReady: where it stuck, and why."""
    hold(controlword)
    until = node.bus.clock.now() + STEP_PATIENCE
    while (state := state_of(node.sdo.read_uint(0x6041))) != wanted:
        if state.startswith("fault"):
            raise NotReady(f"{node.who} is in {state}: {error_of(node)}")
        if node.bus.clock.now() > until:
            stuck = f"{node.who} stays in '{state}', expected '{wanted}' within {STEP_PATIENCE:g} s"
            raise NotReady(stuck + (HELD_OFF if state == BARRED else ""))
        hold(controlword)


def reset(node: Node, hold: Hold) -> None:
    """The rising edge of bit 7, then disabled. Raises NotReady when the fault stays."""
    for word in (DISABLE, RESET, DISABLE):
        hold(word)
        node.bus.wait(0.01, lambda: False)
    word = node.sdo.read_uint(0x6041)
    state = state_of(word)
    if state.startswith("fault"):
        raise NotReady(f"{node.who} stays in {state} after a reset: {error_of(node)}")
    if word & OPERATES:
        raise NotReady(f"{node.who} is still energised, in '{state}', expected 'switch on disabled' after a reset")


def error_of(node: Node) -> str:
    """Why it is in fault, in words. Raises NotReady when the node is silent."""
    code = node.sdo.read_uint(0x603F, default=0)
    return node.emergency or f"error {code:04X}h, {emergency_text(code)}"


def confirmed_off(node: Node, inputs: Inputs, hold: Hold) -> bool:
    """By the statusword after a SYNC, the first of `inputs`: SDO answers may be late, or somebody else's. Where that
    does not come, the controlword once more by SDO: a drive may take no PDOs, or lose ours on their way.
    """
    if _seen_off(node, inputs, hold):
        return True
    if node.bus.dead:
        return False
    if node.rebooted or node.aside(node.bus.clock.now()):
        return _off_by_sdo(node)
    with contextlib.suppress(NotReady):
        node.sdo.put(0x6040, 0, struct.pack("<H", DISABLE))
        return _seen_off(node, inputs, hold)
    return False


def _seen_off(node: Node, inputs: Inputs, hold: Hold) -> bool:
    """Whether a statusword says so within CONFIRM."""
    until = node.bus.clock.now() + CONFIRM
    while node.bus.clock.now() < until and not node.bus.dead:
        with contextlib.suppress(NotReady):
            inputs.first(CONFIRM / 10)
        if not is_never(inputs.take()) and not int(inputs.values[0]) & OPERATES:
            return True
        hold(DISABLE)
    return False


def _off_by_sdo(node: Node) -> bool:
    """Who lives and is not operational takes and tells no PDOs: it has rebooted, or somebody else has stopped it,
    enabled as it may be.
    """
    with contextlib.suppress(NotReady):
        node.pause()  # one that is stopped answers nothing
        node.sdo.put(0x6040, 0, struct.pack("<H", DISABLE))
        return not node.sdo.read_uint(0x6041) & OPERATES
    return False
