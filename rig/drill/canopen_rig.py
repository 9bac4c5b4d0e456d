"""A CiA 402 drive, a CiA 406 encoder and a CiA 404 transducer on one bus."""

from __future__ import annotations

import struct
from typing import Any, final

from rig.bench import Bench, read
from rig.drill.rig import STALE, DrillRig
from sim.wire.states402 import DriveState

BENCH = "twin-canopen"
BOOTED = 0.1  # s
COMMAND = 0x201  # RPDO 1 of the drive
ENERGISED = 0x0F  # controlword: operation enabled


@final
class CanopenRig(DrillRig):
    """As the shipped bench has it."""

    def read_bench(self) -> Bench:
        """The shipped one."""
        self.wire.wait_until(BOOTED)
        return read(BENCH, [STALE])

    def connect(self, **options: Any) -> Any:
        """The one bus there is."""
        return self.recorded(self.wire.connect(**options))

    def torque_in(self, identifier: int, data: bytes) -> bool:
        """Controlword and target torque of RPDO 1."""
        if identifier != COMMAND:
            return False
        word, permille = struct.unpack("<Hh", data)
        return bool(word == ENERGISED and permille)

    @property
    def energised(self) -> bool:
        """Operation enabled."""
        return self.assembly.drive.drive_state is DriveState.OPERATION_ENABLED
