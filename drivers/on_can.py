"""What the drives on a CAN bus have in common."""

from __future__ import annotations

from drivers.bus import Bus
from rig.core.devices import Drive


class OnCan(Drive):
    """A drive on a `bus`, `_connected` between `connect` and `close`."""

    name = "drive"
    bus: Bus
    _connected: bool

    def clear(self) -> None:
        """Nothing: its fault goes by `reset_fault`."""

    def close(self) -> None:
        """Torque off, then off the bus."""
        if self._connected:
            self.halt()
        self._connected = False
        self.bus.close()
