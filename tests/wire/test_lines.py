"""Serial devices on ptys: bytes as they arrive, commands, faults of lines. Time is virtual, the ptys are real."""

from __future__ import annotations

import itertools
import os
import select
import termios
import tty
from collections.abc import Iterator
from pathlib import Path

import pytest
import serial

from rig.core.errors import UsageError
from sim.wire.assembly import Assembly
from sim.wire.pty import LineDevice, SerialLine
from sim.wire.qsb import Qsb
from sim.wire.reactor import Reactor
from sim.wire.serial_torque import AsciiTorque
from sim.wire.socketcand import SocketCand
from sim.wire.spoilers import Cut, Garbage, Glued, Mute, Torn
from tests.wire.host import assembly

QUIET = ("twin.sensor_noise=0.0", "twin.sensor_zero=0.0")


class Plugged:
    """A device, its line, and the host's end of the pty."""

    def __init__(self, twin: Assembly, folder: Path, device: LineDevice, baud: int, speed: int) -> None:
        self.twin = twin
        self.reactor = Reactor(twin.agenda)
        self.line = SerialLine(twin.agenda, self.reactor, folder / "tty", device, baud)
        self.open(speed)

    def open(self, speed: int) -> None:
        self.end = os.open(self.line.path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        tty.setraw(self.end)
        modes = termios.tcgetattr(self.end)
        modes[4] = modes[5] = speed
        termios.tcsetattr(self.end, termios.TCSANOW, modes)

    def hears(self, seconds: float) -> bytes:
        """What arrives in the next `seconds`."""
        self.twin.agenda.run_until(self.twin.agenda.now + seconds)
        got = b""
        while select.select([self.end], [], [], 0.02)[0]:
            got += os.read(self.end, 65536)
        return got

    def says(self, data: bytes) -> None:
        """Send, and let the device read it."""
        os.write(self.end, data)
        select.select([self.line], [], [], 1.0)
        self.line.ready()

    def close(self) -> None:
        os.close(self.end)
        self.line.close()


@pytest.fixture
def torque(tmp_path: Path) -> Iterator[Plugged]:
    twin = assembly(*QUIET)
    made = Plugged(twin, tmp_path, AsciiTorque(twin.agenda, twin.world, 100.0), 115_200, termios.B115200)
    yield made
    made.close()


@pytest.fixture
def qsb(tmp_path: Path) -> Iterator[Plugged]:
    twin = assembly()
    made = Plugged(twin, tmp_path, Qsb(twin.agenda, twin.world), 230_400, termios.B230400)
    yield made
    made.close()


def test_the_torque_sensor_sends_a_line_per_reading(torque: Plugged) -> None:
    assert (
        torque.hears(0.0505) == b"0.000 Nm\r\n" * 5
    )  # at 0, 10 … 40 ms; the one at 50 ms is 0.9 ms long and still on its way


def test_it_answers_a_question_and_takes_a_zero(torque: Plugged) -> None:
    torque.line.device.rate = 0.0  # type: ignore[attr-defined]
    torque.line.unplug()
    os.close(torque.end)
    torque.line.plug()
    torque.open(termios.B115200)
    torque.twin.world.command(1.0)
    torque.twin.world.lock_output()
    torque.hears(1.0)
    torque.says(b"?\r")
    first = torque.hears(0.01)
    assert first.endswith(b" Nm\r\n")
    assert abs(float(first.split()[0])) > 10.0
    torque.says(b"Z\r?")
    torque.says(b"\r")
    assert abs(float(torque.hears(0.01).split()[0])) < 0.01


def test_bytes_take_the_time_of_their_baud_rate(torque: Plugged) -> None:
    start = torque.twin.agenda.now
    torque.line.send(b"x" * 1152)  # a tenth of a second
    torque.hears(0.0999 + start - torque.twin.agenda.now)
    assert b"x" in torque.hears(0.02)


def test_at_another_baud_rate_there_is_nothing_but_rubbish(torque: Plugged) -> None:
    os.close(torque.end)
    torque.open(termios.B9600)
    torque.hears(0.0)
    got = torque.hears(0.1)
    assert got
    assert all(byte >= 0x80 for byte in got)


def test_lines_are_torn_glued_shortened_spoiled_muted(torque: Plugged) -> None:
    torque.hears(0.005)
    torque.line.spoiler = Torn(0.005)
    assert torque.hears(0.0089).endswith(b"0.000")
    assert torque.hears(0.005) == b" Nm\r\n"
    torque.line.spoiler = Glued()
    assert b"0.000 Nm0.000 Nm\r\n" in torque.hears(0.05)
    torque.line.spoiler = Cut(3)
    assert b"0.000\r\n" in torque.hears(0.02)
    torque.line.spoiler = Garbage(3)
    assert b"\xff\xf8\xf10.000 Nm\r\n" in torque.hears(0.02)
    torque.line.spoiler = Mute()
    torque.hears(0.01)
    assert torque.hears(0.1) == b""


def test_an_adapter_that_waits_hands_over_in_lumps(torque: Plugged) -> None:
    torque.line.latency = 0.05
    torque.hears(0.05 - torque.twin.agenda.now % 0.05 + 0.001)
    assert torque.hears(0.045) == b""
    assert torque.hears(0.01).count(b"\r\n") in (4, 5)


def test_a_pulled_plug_is_an_error_and_another_pty_when_it_is_back(torque: Plugged) -> None:
    before = os.readlink(torque.line.path)
    port = serial.Serial(str(torque.line.path), 115_200, timeout=0)
    torque.line.unplug()
    assert not torque.line.path.exists()
    with pytest.raises(serial.SerialException):
        port.read(1)
    port.close()
    hold = os.open("/dev/ptmx", os.O_RDWR | os.O_NOCTTY)  # somebody else takes the number that got free
    torque.line.plug()
    assert torque.line.path.exists()
    assert os.readlink(torque.line.path) != before
    os.close(hold)


def test_a_device_that_restarts_forgets_its_zero_on_the_same_line(torque: Plugged) -> None:
    torque.twin.world.command(0.7)
    torque.twin.world.lock_output()
    torque.hears(1.0)
    torque.says(b"Z\r")
    assert abs(float(torque.hears(0.02).split()[0])) < 0.01
    torque.line.device.plugged()
    assert abs(float(torque.hears(0.02).split(b"\r\n")[-2].split()[0])) > 5.0


def test_a_host_that_does_not_read_loses_bytes_and_blocks_nobody(torque: Plugged) -> None:
    torque.twin.agenda.run_until(30.0)
    assert torque.line.lost > 0


def test_the_qsb_answers_reads_and_writes(qsb: Plugged) -> None:
    qsb.says(b"W0D0\r\n")  # no time stamps
    assert qsb.hears(0.01) == b"w0D00000000!\n"
    qsb.says(b"W0303\r\n")
    assert qsb.hears(0.01) == b"w0300000003!\n"
    qsb.says(b"R0E\r\n")
    assert qsb.hears(0.01) == b"r0E00000000!\n"
    qsb.says(b"R0")
    qsb.says(b"B\n")  # torn, and ended by a line feed alone
    assert qsb.hears(0.01) == b"r0B00000000!\n"
    qsb.says(b"W15000003\r")
    assert qsb.hears(0.01) == b"w1500000003!\r\n"
    qsb.says(b"RFF\rhello\r")
    assert qsb.hears(0.01) == b"eFF00000002!\r\ne0000000001!\r\n"


def test_the_qsb_counts_in_twos_complement_and_streams(qsb: Plugged) -> None:
    qsb.says(b"W0D0\r")
    qsb.hears(0.01)
    qsb.twin.world.command(-1.0)
    qsb.hears(0.4)
    qsb.twin.world.command(0.0)
    qsb.hears(3.0)
    qsb.says(b"R0E\r")
    value = int(qsb.hears(0.01)[3:11], 16)
    assert value > 0xFFF00000  # it went backwards
    qsb.says(b"S0E\r")
    stream = qsb.hears(0.1).split(b"\n")
    assert set(stream[:-1]) == {b"s0E%08X!" % value}
    assert len(stream) > 100  # 0.56 ms each at 230 400 baud
    qsb.says(b"R0E\r")
    qsb.hears(0.01)
    assert qsb.hears(0.1) == b""


def test_the_qsb_streams_at_its_interval_and_by_its_threshold(qsb: Plugged) -> None:
    qsb.says(b"W0C33\r")  # 51 ticks of 1/512 s: a tenth of a second
    qsb.hears(0.01)
    qsb.says(b"S0E\r")
    stream = qsb.hears(1.0).split(b"\n")[:-1]
    assert len(stream) in (10, 11)
    stamps = [int(line[11:19], 16) for line in stream]
    assert {b - a for a, b in itertools.pairwise(stamps)} <= {51, 52}
    qsb.says(b"W0B0A\r")
    qsb.hears(0.01)
    assert qsb.hears(1.0) == b""  # nothing moves by ten counts


def test_the_qsb_forgets_without_power_what_was_not_stored(qsb: Plugged) -> None:
    for store, kept in ((b"", 0), (b"W163\r", 7)):
        qsb.says(b"W0B7\r" + store)
        qsb.hears(0.01)
        qsb.line.unplug()
        os.close(qsb.end)
        qsb.line.plug()
        qsb.open(termios.B230400)
        qsb.says(b"R0B\r")
        assert int(qsb.hears(0.01)[3:11], 16) == kept


def test_a_file_that_has_the_name_of_a_line_is_left_and_a_link_of_an_earlier_twin_is_not(tmp_path: Path) -> None:
    twin = assembly(*QUIET)
    device = AsciiTorque(twin.agenda, twin.world, 100.0)
    (tmp_path / "tty").write_text("the only copy")
    with pytest.raises(UsageError, match="is not a link of an earlier twin; it stays as it is"):
        SerialLine(twin.agenda, Reactor(twin.agenda), tmp_path / "tty", device, 115_200)
    assert (tmp_path / "tty").read_text() == "the only copy"
    (tmp_path / "left").symlink_to("/dev/pts/nobody")
    line = SerialLine(twin.agenda, Reactor(twin.agenda), tmp_path / "left", device, 115_200)
    assert (tmp_path / "left").resolve() != Path("/dev/pts/nobody")
    line.close()


@pytest.mark.parametrize("port", [-1, 65536, 99999])
def test_a_port_that_does_not_exist_is_a_sentence(port: int) -> None:
    twin = assembly(*QUIET)
    with pytest.raises(UsageError, match=f"socketcand at port {port}: ports go from 0"):
        SocketCand(twin.bus, Reactor(twin.agenda), port)
