"""The serial CAN adapter, in text written by hand. No pty here: bytes in, bytes out."""

from __future__ import annotations

from typing import Any

import pytest

from sim.wire.agenda import Agenda
from sim.wire.bus import Bus
from sim.wire.frame import EXTENDED, REMOTE, Frame
from sim.wire.slcan import SerialCan, line_of


class Adapter:
    """The adapter between a bus with another station and a line that keeps what it is given."""

    present = True

    def __init__(self) -> None:
        self.agenda = Agenda()
        self.bus = Bus(self.agenda, 1e6)
        self.heard: list[Frame] = []
        self.other = self.bus.attach("other", lambda frame, t: self.heard.append(frame))
        self.said = b""
        self.device = SerialCan(self.bus)
        self.device.line = self  # type: ignore[assignment]
        self.device.plugged()

    def send(self, data: bytes) -> None:
        self.said += data

    def tell(self, text: bytes) -> bytes:
        self.said = b""
        self.device.receive(text)
        self.agenda.run_until(self.agenda.now + 0.01)
        return self.said


@pytest.fixture
def adapter() -> Adapter:
    made = Adapter()
    made.tell(b"S8\rO\r")
    return made


@pytest.mark.parametrize(
    ("text", "answer", "frame"),
    [
        (b"t12321122\r", b"z\r", Frame(0x123, b"\x11\x22")),
        (b"t0800\r", b"z\r", Frame(0x080)),
        (b"T0012345621122\r", b"Z\r", Frame(0x123456 | EXTENDED, b"\x11\x22")),
        (b"r7011\r", b"z\r", Frame(0x701 | REMOTE, b"\0")),
    ],
)
def test_frames_go_to_the_bus(adapter: Adapter, text: bytes, answer: bytes, frame: Frame) -> None:
    assert adapter.tell(text) == answer
    assert adapter.heard == [frame]


@pytest.mark.parametrize("text", [b"t123\r", b"t12391122\r", b"t123211\r", b"txyz0\r", b"q\r", b"S9\r"])
def test_what_is_no_command_is_answered_with_a_bell(adapter: Adapter, text: bytes) -> None:
    assert adapter.tell(text) == b"\a"
    assert adapter.heard == []


@pytest.mark.parametrize(
    ("frame", "text"),
    [
        (Frame(0x181, b"\xab\xcd"), b"t1812ABCD\r"),
        (Frame(0x123456 | EXTENDED, b"\x01"), b"T00123456101\r"),
        (Frame(0x701 | REMOTE, b"\0"), b"r7011\r"),
    ],
)
def test_frames_come_from_the_bus(adapter: Adapter, frame: Frame, text: bytes) -> None:
    adapter.other.send(frame)
    assert adapter.tell(b"") == text
    assert line_of(frame) == text


def test_commands_may_come_in_pieces(adapter: Adapter) -> None:
    assert adapter.tell(b"t12") == b""
    assert adapter.tell(b"30\rt1240") == b"z\r"
    assert adapter.tell(b"\r") == b"z\r"
    assert [frame.identifier for frame in adapter.heard] == [0x123, 0x124]


def test_a_closed_channel_and_a_wrong_bit_rate_are_silent(adapter: Adapter) -> None:
    frame: Any = Frame(0x181)
    adapter.tell(b"C\r")
    adapter.other.send(frame)
    assert adapter.tell(b"t1230\r") == b"\a"
    adapter.tell(b"S6\rO\r")
    adapter.other.send(frame)
    assert adapter.tell(b"t1230\r") == b"z\r"
    assert adapter.heard == []
    adapter.tell(b"C\rS8\rO\r")
    adapter.other.send(frame)
    assert adapter.tell(b"V\r") == b"V1013\rt1810\r"
