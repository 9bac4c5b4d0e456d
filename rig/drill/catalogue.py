"""Which rigs can be drilled: how each is made, what can go wrong with it."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from rig.drill import causes, odrive_causes
from rig.drill.canopen_rig import CanopenRig
from rig.drill.cause import Cause
from rig.drill.odrive_rig import ODriveRig
from rig.drill.rig import DrillRig


class Kind(NamedTuple):
    """One of them."""

    words: str
    made: Callable[[], DrillRig]
    causes: tuple[Cause, ...]


RIGS: dict[str, Kind] = {
    "cia402": Kind("CANopen nodes", CanopenRig, causes.CAUSES),
    "odrive": Kind("ODrive, and CANopen sensors", ODriveRig, odrive_causes.CAUSES),
}
