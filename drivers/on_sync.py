"""What the CANopen sensors have in common: one node, latched on SYNC, on a bus it shares with others."""

from __future__ import annotations

from abc import abstractmethod

from drivers.bus import Bus
from drivers.node import Node
from drivers.pdo import Inputs
from rig.core.devices import Device


class OnSync(Device):
    """A sensor whose newest value comes in `_inputs` of its `node`."""

    bus: Bus
    node: Node
    _inputs: Inputs

    @abstractmethod
    def read(self) -> object:
        """The newest value; never waits for one."""

    def clear(self) -> None:
        """Forget emergencies, look anew. Raises NotReady: silent, or rebooted, its configuration lost."""
        self.node.revive()
        self._inputs.wrong = ""
        self._inputs.first(0.5)
        self.read()

    def close(self) -> None:
        """Off the bus."""
        self.bus.close()
