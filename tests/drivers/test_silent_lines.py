"""One serial device that falls silent while the others live: which it is, latched until it tells again."""

from __future__ import annotations

import contextlib
import os
import re
import select
import threading
import tty
from collections.abc import Iterator

import pytest

from drivers.ascii_torque import AsciiTorque
from drivers.qsb import Qsb
from drivers.wiring import Place, Wiring
from rig.control.filter import SpeedFilter
from rig.core.errors import NotReady
from rig.core.procedure import Setting
from rig.guard import Guard
from rig.instruments import Instruments
from rig.loop import Ending, Loop
from rig.procedures.standstill import Standstill
from rig.process.interrupts import Interrupts
from rig.supervisor import Act, State, Supervisor
from rig.timing.ticks import LoopTiming
from tests.fakes import LIMITS, SETTING, FakeClock, FakeDrive, FakeWorld, ListSink

DELIVERED = 10.0  # s a busy machine may take to hand over what was written to a pseudo terminal
QSB, TORQUE = b"s0E00000007!\r\n", b"1.25 Nm\r\n"


class Peer:
    """The far end of a serial line: answers a QSB's questions by itself, and tells its reading when asked to."""

    def __init__(self, line: bytes) -> None:
        self.line, self.mute, self.every, self.ticks = line, False, 1, 0
        self.master, self.slave = os.openpty()
        tty.setraw(self.slave)
        self.path = os.ttyname(self.slave)

    def answers(self) -> None:
        """Until it is told to stream; for a thread."""
        heard = b""
        while b"S0E" not in heard:
            heard += os.read(self.master, 100)
            while found := re.match(rb"\s*([RW])([0-9A-F]{2})([0-9A-F]{8})?\r\n", heard):
                heard = heard[found.end() :]
                os.write(self.master, found[1].lower() + found[2] + (found[3] or b"00000007") + b"!\r\n")

    def says(self) -> None:
        """One reading."""
        if not self.mute:
            os.write(self.master, self.line)

    def tells(self) -> None:
        """One reading, or one in `every` ticks, there for the host when this returns."""
        self.ticks += 1
        if self.ticks % self.every == 0:
            self.says()
        if not self.mute and self.ticks % self.every == 0:
            assert select.select([self.slave], [], [], DELIVERED)[0]

    def close(self) -> None:
        os.close(self.master)
        os.close(self.slave)


@contextlib.contextmanager
def saying(*peers: Peer) -> Iterator[None]:
    """Those that live go on telling meanwhile, a hundred times a second."""
    over = threading.Event()

    def say() -> None:
        while not over.wait(0.01):
            for peer in peers:
                peer.says()

    thread = threading.Thread(target=say)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


class Telling(FakeClock):
    """Before every tick each line that lives has told its reading."""

    def __init__(self, peers: list[Peer]) -> None:
        super().__init__()
        self.peers = peers

    def wait_until(self, t: float) -> float:
        for peer in self.peers:
            peer.tells()
        return super().wait_until(t)


class Bench:
    """A drive that is a few lines of code, encoder and torque sensor on serial lines, virtual time."""

    def __init__(self) -> None:
        self.encoder, self.torque = Peer(QSB), Peer(TORQUE)
        self.world = FakeWorld(Telling([self.encoder, self.torque]))
        wiring = Wiring(self.world.clock)
        qsb = Qsb(wiring, Place("load_encoder", {"port": self.encoder.path}, 900_000, speed_limit=1.0))
        sensor = AsciiTorque(wiring, Place("torque_sensor", {"port": self.torque.path, "baud": 115_200}, range=50.0))
        self.instruments = Instruments(FakeDrive(self.world), qsb, sensor, self.world.clock, SpeedFilter(0.008))
        self.supervisor = Supervisor(causes=self.instruments.causes)
        answering = threading.Thread(target=self.encoder.answers, daemon=True)
        answering.start()
        with saying(self.torque):
            self.instruments.connect()
        answering.join(DELIVERED)
        for act in (Act.CONNECT, Act.CHECK):
            self.supervisor.act(act)

    def run(self) -> Ending:
        procedure = Standstill(duration=0.5)
        guard = Guard(LIMITS, procedure.envelope(SETTING), SETTING.ratio)
        timing = LoopTiming(SETTING.period, virtual=True)
        setting: Setting = SETTING
        return Loop(self.instruments, self.supervisor, guard, ListSink(), Interrupts(), timing).run(procedure, setting)

    def reset(self) -> None:
        """As a session does it."""
        self.instruments.drive.reset_fault()
        for device in self.instruments.devices:
            device.clear()
        self.supervisor.act(Act.RESET)

    def close(self) -> None:
        self.instruments.close()
        self.encoder.close()
        self.torque.close()


@pytest.fixture
def bench() -> Iterator[Bench]:
    made = Bench()
    yield made
    made.close()


def test_with_both_lines_alive_a_run_comes_to_its_end(bench: Bench) -> None:
    assert bench.run().status == "completed"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("which", "words", "refused"),
    [
        ("encoder", "no new load-encoder sample for", "load encoder on .* has told no count for 1 s"),
        ("torque", "no new torque-sensor sample for", "torque sensor on .* has told no torque for 1 s"),
    ],
)
def test_the_line_that_falls_silent_is_named_and_the_fault_stays_until_it_tells_again(
    bench: Bench, which: str, words: str, refused: str
) -> None:
    peer: Peer = getattr(bench, which)
    bench.world.clock.at[200] = lambda: setattr(peer, "mute", True)
    ending = bench.run()
    assert ending.status == "tripped"
    assert ending.reason.startswith(words)
    assert bench.world.history[-1] == "halt"
    with saying(bench.encoder, bench.torque), pytest.raises(NotReady, match=refused):
        bench.reset()
    assert bench.supervisor.state is State.FAULT
    peer.mute = False
    assert bench.supervisor.state is State.FAULT, "its coming back is no reset"
    with saying(bench.encoder, bench.torque):
        bench.reset()
    assert bench.supervisor.state is State.CONNECTED


def test_a_line_that_tells_in_another_unit_is_not_called_silent_but_what_it_is(bench: Bench) -> None:
    bench.world.clock.at[200] = lambda: setattr(bench.torque, "line", b"11.06 lbf.in\r\n")
    ending = bench.run()
    assert ending.status == "tripped"
    meanwhile = (
        r"no new torque-sensor sample .*; torque sensor on \S+ sent \d+ bytes meanwhile, and no line that says a"
    )
    assert re.match(meanwhile, ending.reason)


def test_a_slow_line_that_lives_is_not_named_beside_the_one_that_fell_silent(bench: Bench) -> None:
    bench.torque.every = 3
    bench.world.clock.at[200] = lambda: setattr(bench.encoder, "mute", True)
    assert bench.run().reason.startswith("no new load-encoder sample for")


@pytest.mark.parametrize("before", [b"", b"e0000000001!\r\n"], ids=["", "after half a command of somebody else"])
def test_a_qsb_that_refuses_a_command_says_with_which_error_at_once(before: bytes) -> None:
    """The operator waited a second and read that it did not answer."""
    peer = Peer(b"")
    qsb = Qsb(Wiring(FakeClock()), Place("load_encoder", {"port": peer.path}, 900_000, speed_limit=1.0))
    qsb.port.open()
    os.write(peer.master, b"\r\n" + before + b"e1400000002!\r\n")
    with pytest.raises(NotReady, match=r"load encoder on \S+ refuses R14 with error 2"):
        qsb._ask(b"R14")
    qsb.close()
    peer.close()


@pytest.mark.slow  # a second of patience each
@pytest.mark.parametrize(
    ("line", "told"),
    [
        (b"", "sent nothing in 1 s, expected for example '-12.345 Nm'"),
        (b"\x80\xfe\x18", r"sent \d+ bytes, not one line \(is baud = 9600 right, is its unit N·m\?\) in 1 s"),
        (b"1.25 lbf\r\n", r"sent \d+ bytes, \d+ lines that say no torque \(is baud = 9600 right, is its unit N·m\?\)"),
    ],
)
def test_a_torque_sensor_that_makes_no_sense_is_told_from_one_that_says_nothing(line: bytes, told: str) -> None:
    peer = Peer(line)
    sensor = AsciiTorque(Wiring(FakeClock()), Place("torque_sensor", {"port": peer.path, "baud": 9600}, range=50.0))
    with saying(peer), pytest.raises(NotReady, match=told):
        sensor.connect()
    sensor.close()
    peer.close()
