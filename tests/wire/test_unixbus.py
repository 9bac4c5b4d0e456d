"""python-can's view of the Unix-socket bus against packets written by hand; the other end is a bare socket."""

from __future__ import annotations

import socket
import struct
import time
from collections.abc import Iterator
from pathlib import Path

import can
import pytest

Ends = tuple[can.BusABC, socket.socket]
PACKET = bytes.fromhex("8101000003000000 0a0b0c0000000000 00ca9a3b00000000")  # 181h, 3 bytes, at 1 s


@pytest.fixture
def server(tmp_path: Path) -> Iterator[socket.socket]:
    listening = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    listening.bind(str(tmp_path / "can"))
    listening.listen()
    yield listening
    listening.close()


@pytest.fixture
def ends(server: socket.socket) -> Iterator[Ends]:
    """python-can's end and the other one."""
    with can.Bus(interface="hdrig-unix", channel=server.getsockname()) as bus, server.accept()[0] as other:
        yield bus, other


def test_python_can_finds_it_by_name_and_a_packet_is_a_message(ends: Ends) -> None:
    bus, other = ends
    other.send(PACKET)
    message = bus.recv(1.0)
    assert message is not None
    assert (message.arbitration_id, message.is_extended_id, message.dlc) == (0x181, False, 3)
    assert bytes(message.data) == b"\x0a\x0b\x0c"
    assert message.timestamp == pytest.approx(1.0 + time.time() - time.monotonic(), abs=0.1)
    assert bus.recv(0) is None
    assert bus.recv(0.001) is None


@pytest.mark.parametrize(
    ("packet", "identifier", "extended", "remote", "error"),
    [
        ("56341280 02000000 0102000000000000 0000000000000000", 0x123456, True, False, False),
        ("01070040 01000000 0000000000000000 0000000000000000", 0x701, False, True, False),
        ("40000020 08000000 0000000000000000 0000000000000000", 0x40, False, False, True),
    ],
)
def test_the_flags_are_those_of_linux(
    ends: Ends, packet: str, identifier: int, extended: bool, remote: bool, error: bool
) -> None:
    bus, other = ends
    other.send(bytes.fromhex(packet))
    message = bus.recv(1.0)
    assert message is not None
    assert message.arbitration_id == identifier
    assert (message.is_extended_id, message.is_remote_frame, message.is_error_frame) == (extended, remote, error)


def test_a_message_is_a_packet(ends: Ends) -> None:
    bus, other = ends
    bus.send(can.Message(arbitration_id=0x201, data=b"\x0f\x00", is_extended_id=False))
    assert other.recv(64) == bytes.fromhex("0102000002000000 0f00000000000000 0000000000000000")
    bus.send(can.Message(arbitration_id=0x123456, data=b"\x01", is_extended_id=True))
    assert other.recv(64) == bytes.fromhex("5634128001000000 0100000000000000 0000000000000000")
    bus.send(can.Message(arbitration_id=0x701, is_remote_frame=True, dlc=1, is_extended_id=False))
    assert other.recv(64) == bytes.fromhex("0107004001000000 0000000000000000 0000000000000000")


def test_filters_are_python_cans(ends: Ends) -> None:
    bus, other = ends
    bus.set_filters([{"can_id": 0x182, "can_mask": 0x7FF}])
    other.send(PACKET)
    assert bus.recv(0.01) is None


def test_a_bus_that_is_not_there_or_goes_away_is_said(ends: Ends, tmp_path: Path) -> None:
    with pytest.raises(can.CanInitializationError, match="no CAN bus at"):
        can.Bus(interface="hdrig-unix", channel=str(tmp_path / "nothing"))
    bus, other = ends
    other.close()
    with pytest.raises(can.CanOperationError, match="gone"):
        bus.recv(1.0)
    with pytest.raises(can.CanOperationError, match="cannot send"):
        bus.send(can.Message(arbitration_id=1, is_extended_id=False))
    bus.shutdown()
    bus.shutdown()


def test_a_server_that_does_not_read_makes_sending_fail_not_wait(ends: Ends) -> None:
    bus, other = ends
    message = can.Message(arbitration_id=1, is_extended_id=False)

    def send_all() -> None:
        for _ in range(100_000):
            bus.send(message)

    with pytest.raises(can.CanOperationError, match="queue full"):
        send_all()
    assert len(other.recv(64)) == 24


def test_waiting_frames_keep_their_order(ends: Ends) -> None:
    bus, other = ends
    for number in range(100):
        other.send(struct.pack("<IB3x8sQ", number, 0, b"", 0))
    assert [message.arbitration_id for _ in range(100) if (message := bus.recv(0))] == list(range(100))
