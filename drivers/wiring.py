"""Where devices are plugged in: the buses and ports of one bench, opened once however many devices share them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from drivers.bus import CANOPEN, Bus
from drivers.claim import connect_alone
from rig.core.clock import Clock
from rig.core.errors import UsageError
from rig.core.sample import NAN

UNASKED = {"slcan": {"timeout": 0.0}}  # s; python-can's 1 ms is waited at every look at an empty line, four a tick


LAST = 0.999  # of the range of a torque sensor
CODE = 2.0  # times it, from which on a number is no torque: sensors tell a broken cable by one, amplifiers end before


@dataclass(frozen=True)
class Place:
    """What the bench file says of one device: its own keys, and the numbers it has to agree with."""

    role: str  # drive, load_encoder, torque_sensor
    options: Mapping[str, Any]  # the keys of [devices.ROLE]
    counts_per_turn: int = 0  # of its encoder
    torque_rated: float = 0.0  # N·m
    torque_limit: float = 0.0  # N·m
    speed_limit: float = 0.0  # rad/s at its shaft, more is no measurement
    following: float = 0.0  # rad that it may lag behind its reference at that speed; 0: nobody has said
    range: float = 0.0  # N·m of a torque sensor, either way
    period: float = 0.001  # s, one tick of the loop
    stale: float = 0.0  # s after which the guard ends a run for want of news

    @property
    def where(self) -> str:
        """What errors call the section."""
        return f"devices.{self.role}"

    def at_its_end(self, tau: float) -> bool:
        """Whether a torque [N·m] is the last that a sensor of this range tells, to one of its counts: there may be
        more."""
        return abs(tau) >= LAST * self.range

    def torque(self, told: float) -> float:
        """A torque [N·m] as the sensor told it; no number where it is what stands for an error."""
        return told if not self.range or abs(told) < CODE * self.range else NAN

    def need(self, key: str) -> Any:
        """An option without which the device cannot be reached. Raises UsageError."""
        value = self.options.get(key)
        if value is None:
            raise UsageError(f"{self.where} needs the key '{key}'")
        return value


@dataclass
class Wiring:
    """The buses of a bench by name, as [bus.NAME] says. Opened by the devices on them."""

    clock: Clock
    sections: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    connect: Callable[..., Any] = connect_alone  # what opens a bus
    _buses: dict[str, Bus] = field(default_factory=dict, init=False)

    def bus(self, place: Place, protocol: str = CANOPEN) -> Bus:
        """The bus a device is on. Raises UsageError when none is named, or when the devices that are
        on it already speak another protocol: the same identifiers mean something else there.
        """
        name = place.need("bus")
        if name not in self._buses:
            section = self.sections[name]
            options = {**UNASKED.get(section["interface"], {}), **section.get("options", {})}
            if section.get("bitrate"):
                options["bitrate"] = section["bitrate"]
            made = Bus(name, section["interface"], str(section["channel"]), self.clock, options, self.connect)
            made.protocol = protocol
            made.host_node = section.get("host_node", 0)
            self._buses[name] = made
        found = self._buses[name]
        if found.protocol != protocol:
            raise UsageError(
                f"{place.where}: a {protocol} device on CAN bus '{name}', where others speak {found.protocol}: their "
                "identifiers collide (a CANopen heartbeat of node 127 is 'enter firmware update' of ODrive node 59); "
                "give each protocol a bus of its own"
            )
        return found

    def latch(self) -> None:
        """Have the devices on every open bus take their readings now. Never raises."""
        for bus in self._buses.values():
            bus.latch()
