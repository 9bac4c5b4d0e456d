"""What an ODrive axis says of itself, whatever it does: heartbeat, errors, version      [odrive]"""

from __future__ import annotations

from drivers import cansimple as cs
from drivers.bus import Bus
from rig.core.clock import NEVER, is_never
from rig.core.devices import Identity
from rig.core.errors import NotReady

NODES = range(64)
LISTEN = 0.5  # s in which an axis must have told that it lives; heartbeats come every 100 ms unless set otherwise
ANSWER = 0.1  # s for an answer to a remote frame
PATIENCE = 3.5  # heartbeats that may stay away
FASTEST = 0.02  # s between two: closer ones were held up on their way, and handed over together


class Axis:
    """`node` on a bus. `who` is what errors call it."""

    def __init__(self, bus: Bus, node: int, who: str) -> None:
        self.bus = bus
        self.node = node
        self.who = f"{who} (ODrive node {node} on CAN bus '{bus.name}')"
        self.expired = cs.OLD_WATCHDOG  # the bit that says "watchdog expired"
        self.tells_torque = False  # firmware 0.6 or later; older ones answer 0x1C with a voltage
        self.forgives = 0  # error bits that are no fault while it is idle
        self.state = 0
        self.heard = NEVER  # s on the loop's clock, last heartbeat
        self.interval = 0.1  # s between heartbeats
        self._errors = 0
        self._names = cs.OLD_ERRORS

    def id(self, command: int) -> int:
        """The identifier of one of its frames."""
        return cs.identifier(self.node, command)

    def open(self) -> Identity:
        """Open the bus, listen, and ask who it is. Raises NotReady."""
        if self.node not in NODES:
            raise NotReady(f"{self.who}: CANSimple has nodes 0 to {NODES[-1]}")
        self.bus.open()
        self.bus.listeners[self.id(cs.HEARTBEAT)] = self._on_heartbeat
        self._listen()
        return self._identify()

    def _listen(self) -> None:
        beats: list[float] = []
        until = self.bus.clock.now() + LISTEN
        while len(beats) < 2 and self.next_heartbeat(until - self.bus.clock.now()):
            beats.append(self.heard)
        if len(beats) < 2:
            raise NotReady(
                f"{self.who} sent {len(beats)} heartbeats in {LISTEN:g} s, expected one every 100 ms or faster: "
                "are node number and bitrate right, is CAN enabled in the axis?"
            )
        self.interval = max(beats[1] - beats[0], FASTEST)

    def _identify(self) -> Identity:
        data = self.ask(cs.VERSION)
        if data is None:
            return Identity("ODrive", "", "0.5 or older (does not tell)")
        version = cs.decode_version(data)
        self._names, self.expired, self.tells_torque = cs.PRO_ERRORS, cs.PRO_WATCHDOG, True
        # no board has hardware version 0: who says so is simulated
        model = "ODrive " + ("{}.{}-{}".format(*version.hardware) if version.hardware[0] else "twin")
        return Identity(model, "", "{}.{}.{}".format(*version.firmware))

    def ask(self, command: int) -> bytes | None:
        """Its 8 bytes of `command`, asked for by a remote frame; None when it does not answer."""
        identifier = self.id(command)
        self.bus.frames.pop(identifier, None)
        self.bus.ask(identifier)
        if not self.bus.wait(ANSWER, lambda: identifier in self.bus.frames):
            return None
        data = self.bus.frames[identifier].data
        return data if len(data) == 8 else None

    def send(self, command: int, data: bytes) -> bool:
        """A frame to it; False when the bus is dead. Never raises."""
        return self.bus.send(self.id(command), data)

    def request(self, state: int) -> bool:
        """Ask for an axis state. Never raises."""
        return self.send(cs.SET_STATE, cs.encode_state(state))

    def next_heartbeat(self, seconds: float) -> bool:
        """Wait for one that was not there yet; False when none came."""
        self.bus.drain()  # what lay in the queue is old
        self.heard = NEVER
        return self.bus.wait(seconds, lambda: not is_never(self.heard))

    def fresh(self) -> None:
        """State and errors as of now. Raises NotReady when it is silent."""
        if not self.next_heartbeat(PATIENCE * self.interval):
            raise NotReady(self.silence())

    def clear(self) -> None:
        """Clear its errors; `error` tells what came back. Never energises it. Raises NotReady when it is silent."""
        self.send(cs.CLEAR, b"\0")
        self.fresh()
        if self._errors:
            self.fresh()  # that one may have been on its way

    @property
    def expired_now(self) -> bool:
        """Its watchdog says so."""
        return bool(self._errors & self.expired)

    @property
    def any_error(self) -> bool:
        """Any at all, a forgivable one included."""
        return bool(self._errors)

    @property
    def error(self) -> str:
        """What is wrong, in words; "" when nothing is that matters."""
        if not self._errors & ~self.forgives:
            return ""
        return f"{self.who} is in error: {cs.error_text(self._errors, self._names)} (error {self._errors:08X}h)"

    def state_text(self) -> str:
        """Its state in words."""
        return cs.STATES.get(self.state, f"state {self.state}")

    def overdue(self) -> bool:
        """Heartbeats have stayed away for too long."""
        return self.bus.clock.now() - self.heard > PATIENCE * self.interval

    def silence(self) -> str:
        """The sentence for that."""
        return (
            f"no heartbeat of {self.who} for {PATIENCE * self.interval * 1e3:.0f} ms, expected one every "
            f"{self.interval * 1e3:.0f} ms"
        )

    def _on_heartbeat(self, data: bytes, t: float) -> None:
        if len(data) == 8:
            (self._errors, self.state), self.heard = cs.decode_heartbeat(data), t
