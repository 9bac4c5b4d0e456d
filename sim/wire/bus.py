"""A CAN bus with its time: one frame at a time, the lowest identifier first, everybody else hears it at its end."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence

from sim.wire.agenda import Agenda
from sim.wire.frame import Frame

WINDOW = 0.5  # s over which the load is averaged
MOST_WAITING = 64  # frames of one host that may wait for the bus; then it is not read, and its socket fills
Receive = Callable[[Frame, float], None]  # frame, modelled time [s] at which it had passed


class Tamper:
    """Something wrong with the wire itself; the base class is a sound one."""

    done = False

    def pass_on(self, frame: Frame) -> Sequence[tuple[float, Frame]]:
        """What arrives in place of `frame`: (s later, frame) for each."""
        return ((0.0, frame),)


class Port:
    """One station's connection: sends first come first served, as a host's transmit queue does."""

    def __init__(self, bus: Bus, name: str, receive: Receive) -> None:
        self.name = name
        self.receive = receive
        self.queue: deque[Frame] = deque()
        self.connected = True
        self.keeps = (
            False  # while disconnected: keep what is sent and send it on return (a controller's queue), or lose it
        )
        self.lost = 0  # frames sent while disconnected
        self._bus = bus

    def send(self, frame: Frame) -> None:
        """Queue a frame; it goes when the bus is free and it wins."""
        if self.connected or self.keeps:
            self.queue.append(frame)
            self._bus.request()
        else:
            self.lost += 1

    @property
    def has_room(self) -> bool:
        """Whether a host may be read further."""
        return len(self.queue) < MOST_WAITING

    def disconnect(self, keeps: bool) -> None:
        """The cable is out; `keeps` says whether what is sent meanwhile goes out on return."""
        self.connected, self.keeps = False, keeps

    def reconnect(self) -> None:
        """The cable is back."""
        self.connected = True
        self._bus.request()

    def leave(self) -> None:
        """No longer there, and what waits to be sent with it."""
        self.queue.clear()
        self._bus.ports.remove(self)


class Bus:
    """`bitrate` in bit/s; infinite for a bus that takes no time."""

    def __init__(self, agenda: Agenda, bitrate: float) -> None:
        self.agenda, self.bitrate = agenda, bitrate
        self.ports: list[Port] = []
        self.tampers: list[Tamper] = []
        self.frames = 0  # that have passed
        self.load = 0.0  # 1, over the last WINDOW
        self._free_at = 0.0  # s
        self._asked = False
        self._busy = 0.0  # s of this window
        agenda.after(WINDOW, self._measure)

    def attach(self, name: str, receive: Receive) -> Port:
        """A new station."""
        port = Port(self, name, receive)
        self.ports.append(port)
        return port

    def request(self) -> None:
        """Somebody has something to send."""
        if not self._asked:
            self._asked = True
            self.agenda.at(self._free_at, self._arbitrate)

    def _arbitrate(self) -> None:
        self._asked = False
        ready = [port for port in self.ports if port.queue and port.connected]
        if not ready:
            return
        sender = min(ready, key=lambda port: port.queue[0].rank)
        frame = sender.queue.popleft()
        duration = frame.bits / self.bitrate
        self._busy += duration
        self._free_at = self.agenda.now + duration
        self.agenda.at(self._free_at, lambda: self._pass(sender, frame))
        self.request()

    def _pass(self, sender: Port, frame: Frame) -> None:
        self.frames += 1
        arrivals = [(0.0, frame)]
        for tamper in self.tampers:
            arrivals = [(d + more, out) for d, one in arrivals for more, out in tamper.pass_on(one)]
        if self.tampers:
            self.tampers = [tamper for tamper in self.tampers if not tamper.done]
        for delay, arriving in arrivals:
            if delay > 0.0:
                self.agenda.after(delay, lambda late=arriving: self._deliver(sender, late))  # type: ignore[misc]
            else:
                self._deliver(sender, arriving)

    def _deliver(self, sender: Port, frame: Frame) -> None:
        now = self.agenda.now
        for port in tuple(self.ports):
            if port is not sender and port.connected:
                port.receive(frame, now)

    def _measure(self) -> None:
        self.load, self._busy = self._busy / WINDOW, 0.0
        self.agenda.after(WINDOW, self._measure)
