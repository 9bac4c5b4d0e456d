"""The objects of one CANopen node, read and written over SDO; what is written is verified by reading it back.

SDO is canopen's, but in the caller's thread: its queue of answers takes frames from the bus itself, so that no receive
thread is needed, before a run or in it.
"""

from __future__ import annotations

import contextlib
import logging
import math
import queue
from typing import Any

from drivers.bus import GONE, Bus
from rig.core.can_libraries import canopen
from rig.core.errors import NotReady

logging.getLogger("canopen").setLevel(logging.CRITICAL)  # it logs what we say in sentences

NO_OBJECT = 0x06020000  # abort code
UNSURE = {0x05040000}  # abort codes that are no answer: the node itself ran out of time
LOST = (canopen.SdoCommunicationError, *GONE)  # no answer, or an adapter that takes no frame, by whatever error
MISSING = object()


class Refused(NotReady):
    """The node answered, with no. Other ways may lead there."""


class _Answers(queue.Queue[bytes]):
    """SDO answers, fetched from the bus by whoever waits for them."""

    def __init__(self, bus: Bus) -> None:
        super().__init__()
        self._bus = bus

    def empty(self) -> bool:
        """Asked before each request: what came too late for the last one is thrown away."""
        self._bus.drain()
        while self.qsize():
            super().get(block=False)
        return True

    def get(self, block: bool = True, timeout: float | None = None) -> bytes:
        """The next answer. Raises queue.Empty."""
        if not self._bus.wait(timeout or 0.0, lambda: self.qsize() > 0):
            raise queue.Empty
        return super().get(block=False)


class Sdo:
    """Access to the objects of node `number`; `who` is what errors call it."""

    def __init__(self, bus: Bus, number: int, who: str) -> None:
        self._bus = bus
        self._number = number
        self._who = who
        self._client: Any = None

    def open(self) -> None:
        """Listen for answers on the open bus; nothing is asked yet."""
        network = canopen.Network()
        network.bus = self._bus.raw
        remote = canopen.RemoteNode(self._number, canopen.ObjectDictionary())  # type: ignore[no-untyped-call]
        remote.associate_network(network)
        self._client = remote.sdo
        self._client.responses = _Answers(self._bus)
        self._bus.listeners[0x580 + self._number] = self._on_answer

    def patience(self, seconds: float) -> None:
        """How long an answer may take from now on; canopen's own 0.3 s until then."""
        self._client.RESPONSE_TIMEOUT = seconds

    def read(self, index: int, sub: int = 0, default: Any = MISSING) -> bytes:
        """An object's bytes; `default` where the node will not tell, whatever code it says so with: nodes do not agree
        on what "no such object" is. Raises NotReady.
        """
        try:
            self._refuse_dead()
            return bytes(self._client.upload(index, sub))
        except canopen.SdoAbortedError as why:
            if why.code not in UNSURE and default is not MISSING:
                return default  # type: ignore[no-any-return]
            raise Refused(f"{self._who} refused to read {index:04X}h:{sub}: {why}") from None
        except LOST as why:
            told = f"{self._who} does not answer (reading {index:04X}h:{sub}: {why})"
            raise NotReady(told + self._bus.silence(-math.inf)) from None

    def lacks(self, index: int) -> bool:
        """The node says, by the standard's own code, that there is no such object. Raises NotReady: it is silent."""
        try:
            self._refuse_dead()
            self._client.upload(index, 0)
        except canopen.SdoAbortedError as why:
            return bool(why.code == NO_OBJECT)
        except LOST as why:
            raise NotReady(f"{self._who} does not answer (reading {index:04X}h: {why})") from None
        return False

    def read_uint(self, index: int, sub: int = 0, default: int | None = None) -> int:
        """An unsigned number, whatever its size. Raises NotReady."""
        raw = self.read(index, sub, MISSING if default is None else default.to_bytes(8, "little"))
        return int.from_bytes(raw, "little")

    def read_int(self, index: int, sub: int = 0) -> int:
        """A signed number. Raises NotReady."""
        return int.from_bytes(self.read(index, sub), "little", signed=True)

    def text(self, index: int) -> str:
        """A string, "" when there is none."""
        return self.read(index, 0, b"").decode(errors="replace").strip("\0 ")

    def write(self, index: int, sub: int, value: bytes) -> None:
        """Write an object and read it back. Raises NotReady when refused, or when it reads back differently."""
        self.put(index, sub, value)
        back = self.read(index, sub)
        if back[: len(value)] != value:
            raise Refused(
                f"{self._who}: wrote {value[::-1].hex()}h to {index:04X}h:{sub}, it reads back {back[::-1].hex()}h"
            )

    def write_if_there(self, index: int, sub: int, value: bytes) -> bool:
        """As `write`; False when the node has no such object. Raises NotReady."""
        try:
            self._refuse_dead()
            self._client.upload(index, sub)
        except canopen.SdoAbortedError as why:
            if why.code not in UNSURE:
                return False
        except LOST:
            pass  # said by the write
        self.write(index, sub, value)
        return True

    def restore(self, index: int, sub: int, value: bytes) -> None:
        """Put back what was there, if the node lets us. Never raises."""
        with contextlib.suppress(NotReady):
            self.put(index, sub, value)

    def put(self, index: int, sub: int, value: bytes) -> None:
        """Write an object that is not to be read back. Raises NotReady."""
        try:
            self._refuse_dead()
            self._client.download(index, sub, value)
        except canopen.SdoAbortedError as why:
            raise Refused(f"{self._who} refused {index:04X}h:{sub} = {value[::-1].hex()}h: {why}") from None
        except LOST as why:
            raise NotReady(f"{self._who} does not answer (writing {index:04X}h:{sub}: {why})") from None

    def _refuse_dead(self) -> None:
        """canopen sends past our bus: one that has failed takes nothing more until it is opened again. Raises
        OSError, as the adapter itself would."""
        if self._bus.dead:
            raise OSError(self._bus.dead)

    def _on_answer(self, data: bytes, t: float) -> None:
        if len(data) == 8:  # every SDO answer has; canopen breaks on others
            self._client.responses.put(data)
