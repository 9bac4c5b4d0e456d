"""`hdrig twin` as a process, reached by libraries that know nothing of it: python-can, canopen, pyserial."""

from __future__ import annotations

import itertools
import json
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import can
import canopen
import pytest
import serial

pytestmark = pytest.mark.slow
PATIENCE = 20.0  # s, for a machine that is busy with something else
CST = 10


class Twin:
    """The process and its command channel."""

    def __init__(self, *options: str, folder: Path | None = None) -> None:
        self.folder = folder or Path(tempfile.mkdtemp(prefix="twin-"))  # a socket's path must be short
        self.lines = self.folder / "lines"
        doors = ["--bus", f"{self.folder}/can", "--control", f"{self.folder}/control", "--socketcand", "0"]
        doors += ["--serial", f"{self.lines}", "--slcan", f"{self.lines}/slcan"]
        self.process = subprocess.Popen(
            [sys.executable, "-m", "rig.cli", "twin", *doors, *options], stdout=subprocess.PIPE, text=True
        )
        assert self.process.stdout is not None
        self.said: list[str] = []
        for line in self.process.stdout:  # ends when the process does
            self.said.append(line.strip())
            if line == "ready\n":
                break
        assert self.said[-1:] == ["ready"]
        self._channel = socket.socket(socket.AF_UNIX)
        self._channel.connect(f"{self.folder}/control")
        self._answers = self._channel.makefile("r")

    def do(self, verb: str, **arguments: Any) -> dict[str, Any]:
        self._channel.send(json.dumps({"do": verb, **arguments}).encode() + b"\n")
        answer: dict[str, Any] = json.loads(self._answers.readline())
        assert answer["ok"], answer
        return answer

    def bus(self) -> can.BusABC:
        return can.Bus(interface="hdrig-unix", channel=f"{self.folder}/can")

    def shut(self) -> None:
        """The command channel."""
        self._answers.close()
        self._channel.close()

    def close(self) -> None:
        self.shut()
        self.process.terminate()
        self.process.wait(PATIENCE)
        assert self.process.stdout is not None
        self.process.stdout.close()
        shutil.rmtree(self.folder)


@pytest.fixture(scope="module")
def twin() -> Iterator[Twin]:
    made = Twin()
    yield made
    made.close()


@pytest.fixture
def network(twin: Twin) -> Iterator[canopen.Network]:
    made = canopen.Network(twin.bus())
    made.connect()
    for number in (1, 2, 3):
        made.add_node(canopen.RemoteNode(number, canopen.ObjectDictionary()))
    booted: set[int] = set()
    for number in (1, 2, 3):
        made[number].sdo.RESPONSE_TIMEOUT = PATIENCE
        made.subscribe(0x700 + number, lambda identifier, data, t: booted.add(identifier))
    made.nmt.state = "RESET"
    wait_for(lambda: len(booted) == 3)
    yield made
    made.disconnect()


def put(network: canopen.Network, node: int, index: int, sub: int, form: str, value: float) -> None:
    network[node].sdo.download(index, sub, struct.pack("<" + form, value))


def get(network: canopen.Network, node: int, index: int, sub: int, form: str) -> Any:
    return struct.unpack("<" + form, network[node].sdo.upload(index, sub))[0]


def wait_for(what: Any) -> None:
    """Until `what()` is true; fails when it never gets so."""
    until = time.monotonic() + PATIENCE
    while not what():
        assert time.monotonic() < until
        time.sleep(0.01)


def enable(network: canopen.Network) -> None:
    network[1].nmt.state = "OPERATIONAL"
    put(network, 1, 0x6060, 0, "b", CST)
    for word in (0x06, 0x07, 0x0F):
        put(network, 1, 0x6040, 0, "H", word)
    wait_for(lambda: get(network, 1, 0x6041, 0, "H") & 0x6F == 0x27)


def test_it_says_that_it_is_simulated_and_how_to_reach_it(twin: Twin) -> None:
    assert twin.said[0].startswith("SIMULATED")
    assert any('interface="hdrig-unix"' in line for line in twin.said)


def test_canopen_reads_names_and_moves_the_motor(twin: Twin, network: canopen.Network) -> None:
    assert network[1].sdo.upload(0x1008, 0) == b"hdrig twin servo drive"
    assert network[2].sdo.upload(0x1008, 0) == b"hdrig twin load encoder"
    assert network[3].sdo.upload(0x1008, 0) == b"hdrig twin torque transducer"
    enable(network)
    put(network, 1, 0x6071, 0, "h", 300)
    wait_for(lambda: get(network, 1, 0x6064, 0, "i") > 10_000)
    assert twin.do("truth")["omega_m"] > 0.0
    put(network, 1, 0x6040, 0, "H", 0)
    wait_for(lambda: twin.do("truth")["omega_m"] == 0.0)


def test_canopens_own_402_machine_walks_the_drive_up_and_resets_its_fault(twin: Twin, network: canopen.Network) -> None:
    dictionary = canopen.ObjectDictionary()
    kinds = canopen.objectdictionary
    for index, kind in [
        (0x6040, kinds.UNSIGNED16),
        (0x6041, kinds.UNSIGNED16),
        (0x6060, kinds.INTEGER8),
        (0x6061, kinds.INTEGER8),
        (0x6502, kinds.UNSIGNED32),
    ]:
        variable = kinds.ODVariable(f"{index:X}", index, 0)
        variable.data_type = kind
        dictionary.add_object(variable)
    network[1].nmt.state = "OPERATIONAL"
    drive = canopen.BaseNode402(1, dictionary)
    network.add_node(drive)
    drive.sdo.RESPONSE_TIMEOUT = drive.TIMEOUT_SWITCH_OP_MODE = drive.TIMEOUT_SWITCH_STATE_FINAL = PATIENCE
    drive.setup_402_state_machine(read_pdos=False)
    assert drive.is_op_mode_supported("CYCLIC SYNCHRONOUS TORQUE")
    assert not drive.is_op_mode_supported("HOMING")
    drive.op_mode = "CYCLIC SYNCHRONOUS TORQUE"
    assert drive.op_mode == "CYCLIC SYNCHRONOUS TORQUE"
    drive.state = "OPERATION ENABLED"
    assert drive.state == "OPERATION ENABLED"
    twin.do("trip", code=0x2310)
    wait_for(lambda: drive.state == "FAULT")
    drive.state = "SWITCH ON DISABLED"
    assert drive.state == "SWITCH ON DISABLED"


def test_canopen_gets_its_aborts(network: canopen.Network) -> None:
    with pytest.raises(canopen.SdoAbortedError) as refused:
        network[1].sdo.upload(0x2000, 0)
    assert refused.value.code == 0x06020000
    with pytest.raises(canopen.SdoAbortedError) as refused:
        put(network, 1, 0x6041, 0, "H", 1)
    assert refused.value.code == 0x06010002


def test_canopen_maps_a_pdo_and_reads_it_on_sync(network: canopen.Network) -> None:
    drive = network[1]
    for index, name, kind in [
        (0x6041, "statusword", canopen.objectdictionary.UNSIGNED16),
        (0x6064, "position", canopen.objectdictionary.INTEGER32),
    ]:
        variable = canopen.objectdictionary.ODVariable(name, index, 0)
        variable.data_type = kind
        drive.object_dictionary.add_object(variable)
    put(network, 1, 0x1800, 1, "I", 0xC0000181)
    put(network, 1, 0x1800, 2, "B", 1)
    put(network, 1, 0x1A00, 0, "B", 0)
    put(network, 1, 0x1A00, 1, "I", 0x60410010)
    put(network, 1, 0x1A00, 2, "I", 0x60640020)
    put(network, 1, 0x1A00, 0, "B", 2)
    put(network, 1, 0x1800, 1, "I", 0x40000181)
    heard: list[bytes] = []
    network.subscribe(0x181, lambda identifier, data, t: heard.append(bytes(data)))
    drive.nmt.state = "OPERATIONAL"
    for _ in range(20):
        network.sync.transmit()
        time.sleep(0.002)
    wait_for(lambda: len(heard) >= 20)
    assert {len(data) for data in heard} == {6}
    assert {struct.unpack("<Hi", data)[0] for data in heard} == {0x0250}


def test_time_stamps_are_those_of_the_modelled_bus(twin: Twin) -> None:
    with twin.bus() as sender, twin.bus() as listener:
        gaps: list[float] = []
        while not gaps or min(gaps) > 112e-6:  # a sender that was held up queues no two in a row
            for _ in range(5):
                sender.send(can.Message(arbitration_id=0x2AA, data=b"\x55" * 8, is_extended_id=False))
            messages = [listener.recv(PATIENCE) for _ in range(5)]
            stamps = [message.timestamp for message in messages if message is not None]
            gaps += [b - a for a, b in itertools.pairwise(stamps)]
            assert len(stamps) == 5
            assert len(gaps) < 4000
        assert min(gaps) == pytest.approx(111e-6, abs=1e-6)  # none can be closer: 111 bits at 1 Mbit/s
        assert abs(stamps[-1] - time.time()) < PATIENCE


def test_a_host_that_does_not_read_loses_the_newest_frames_without_a_word(twin: Twin) -> None:
    with twin.bus() as sender, twin.bus() as sleeper:
        before = twin.do("status")["frames"]
        for number in range(1500):
            sender.send(can.Message(arbitration_id=0x300, data=number.to_bytes(2, "little"), is_extended_id=False), 1.0)
        wait_for(lambda: twin.do("status")["frames"] >= before + 1500)
        kept = list(iter(lambda: sleeper.recv(0), None))
        assert 10 < len(kept) < 1500
        assert [int.from_bytes(message.data, "little") for message in kept] == list(range(len(kept)))


def test_a_host_that_is_killed_stops_its_drive(twin: Twin, network: canopen.Network) -> None:
    put(network, 1, 0x1016, 1, "I", 0x007F0064)
    enable(network)
    host = subprocess.Popen(
        [
            sys.executable,
            "-c",
            "import can, sys, time\n"
            f"bus = can.Bus(interface='hdrig-unix', channel='{twin.folder}/can')\n"
            "while True:\n"
            "    bus.send(can.Message(arbitration_id=0x77F, data=b'\\x05', is_extended_id=False))\n"
            "    print('.', flush=True)\n"
            "    time.sleep(0.02)\n",
        ],
        stdout=subprocess.PIPE,
    )
    assert host.stdout is not None
    for _ in range(10):
        host.stdout.readline()
    put(network, 1, 0x6071, 0, "h", 300)
    host.send_signal(signal.SIGKILL)
    host.wait()
    host.stdout.close()
    wait_for(lambda: get(network, 1, 0x6041, 0, "H") & 0x4F == 0x08)
    assert get(network, 1, 0x603F, 0, "H") == 0x8130
    wait_for(lambda: twin.do("truth")["omega_m"] == 0.0)


@pytest.mark.filterwarnings("ignore::ResourceWarning")  # socketcand's own
def test_the_same_bus_through_slcan_and_socketcand(twin: Twin) -> None:
    port = next(int(line.split("port=")[1].split(",")[0]) for line in twin.said if "socketcand" in line)
    ways: list[dict[str, Any]] = [
        {"interface": "slcan", "channel": f"{twin.lines}/slcan", "sleep_after_open": 0.1, "bitrate": 1_000_000},
        {"interface": "socketcand", "channel": "can0", "host": "127.0.0.1", "port": port},
    ]
    request = can.Message(arbitration_id=0x601, data=bytes.fromhex("4000100000000000"), is_extended_id=False)
    for way in ways:
        with can.Bus(**way) as bus:
            bus.send(request)
            until = time.monotonic() + PATIENCE
            while (message := bus.recv(1.0)) is None or message.arbitration_id != 0x581:
                assert time.monotonic() < until, way
            assert bytes(message.data).hex() == "4300100092010200"


def test_serial_devices_are_read_with_pyserial_and_unplugged(twin: Twin) -> None:
    folder = twin.lines
    with serial.Serial(str(folder / "torque"), 115_200, timeout=PATIENCE, exclusive=True) as port:
        port.readline()
        assert port.readline().endswith(b" Nm\r\n")
    qsb = serial.Serial(str(folder / "qsb"), 230_400, timeout=PATIENCE)
    qsb.write(b"W0D0\r\nR14\r\n")
    assert qsb.readline() == b"w0D00000000!\n"
    assert qsb.readline() == b"r1400000001!\n"
    twin.do("unplug", line="qsb")
    with pytest.raises(serial.SerialException):
        qsb.read(1)
    qsb.close()
    twin.do("plug", line="qsb")
    with serial.Serial(str(folder / "qsb"), 230_400, timeout=PATIENCE) as again:
        again.write(b"R0B\r\n")
        assert again.readline().startswith(b"r0B00000000")


def test_a_stall_is_made_up_for_without_losing_frames(twin: Twin) -> None:
    with twin.bus() as bus:
        before = twin.do("status")["t"]
        twin.do("stall", seconds=0.05)
        request = can.Message(arbitration_id=0x601, data=bytes.fromhex("4000100000000000"), is_extended_id=False)
        bus.send(request)
        assert bus.recv(PATIENCE) is not None
        assert twin.do("status")["t"] - before >= 0.05


def test_a_second_twin_at_the_same_place_is_refused(twin: Twin) -> None:
    doors = ["--bus", f"{twin.folder}/can", "--control", f"{twin.folder}/control"]
    second = subprocess.run(
        [sys.executable, "-m", "rig.cli", "twin", *doors], capture_output=True, text=True, timeout=PATIENCE, check=False
    )
    assert second.returncode == 3
    assert "another twin listens" in second.stderr


def left_behind(twin: Twin) -> list[Path]:
    return [path for path in twin.folder.rglob("*") if path != twin.lines]


def test_it_ends_by_signal_by_word_and_by_time_and_leaves_nothing_behind() -> None:
    for end in ("signal", "word", "time"):
        made = Twin(*(["--for", "0.5"] if end == "time" else []))
        match end:
            case "signal":
                made.process.send_signal(signal.SIGINT)
            case "word":
                made.do("stop")
        assert made.process.wait(PATIENCE) == 0
        assert left_behind(made) == []
        made.close()


def test_what_a_killed_twin_left_is_in_nobodys_way() -> None:
    first = Twin()
    first.process.kill()
    first.process.wait(PATIENCE)
    assert left_behind(first) != []
    second = Twin(folder=first.folder)
    assert second.do("truth")["simulated"] is True
    first.process.stdout.close()  # type: ignore[union-attr]
    first.shut()
    second.close()
