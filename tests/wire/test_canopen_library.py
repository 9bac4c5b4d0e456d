"""Our driver and `hdrig devices` against the Python library canopen, with an object dictionary that is none of ours.

No heartbeat consumer (1016h), no list of modes (6502h), no rated torque (6076h), an odd identity: what is missing is
done without and said, or refused in a sentence. In real time on python-can's virtual bus; nothing here measures time.
"""

from __future__ import annotations

import struct
import time
from collections.abc import Callable, Iterator
from itertools import count
from pathlib import Path

import can
import pytest

from drivers.cia402 import Cia402
from drivers.wiring import Place, Wiring
from rig.cli import main
from rig.config.bench_file import read_bench
from rig.core.clock import WallClock
from rig.core.devices import Identity
from rig.core.errors import NotReady
from rig.core.sample import Torque
from tests.wire.library_drive import LibraryDrive

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("patient")]
NODE = 40
CHANNELS = count()
PATIENCE = 20.0  # s a busy machine may take for what its threads do in a millisecond
Met = tuple[Cia402, LibraryDrive]


@pytest.fixture
def meet() -> Iterator[Callable[..., Met]]:
    """A driver and the library's drive on a bus of their own."""
    made: list[Met] = []

    def together(*lacks: int) -> Met:
        channel = f"library {next(CHANNELS)}"
        peer = LibraryDrive(channel, NODE, frozenset(lacks))
        connect = lambda **_: can.Bus(interface="virtual", channel=channel)  # noqa: E731
        wiring = Wiring(WallClock(), {"rig": {"interface": "virtual", "channel": channel, "host_node": 127}}, connect)
        place = Place("drive", {"bus": "rig", "node": NODE}, 4096, 3.0, 5.0, 62.8, 6.5)
        made.append((Cia402(wiring, place), peer))
        return made[-1]

    yield together
    for driver, peer in made:
        driver.close()
        peer.close()


def until(seen: Callable[[], bool]) -> None:
    """Waits for what the other end's threads do."""
    give_up = time.monotonic() + PATIENCE
    while not seen():
        assert time.monotonic() < give_up
        time.sleep(0.005)


def fresh(driver: Cia402) -> None:
    """A reading after a SYNC of now."""
    before = driver.read().t
    driver.bus.sync()
    until(lambda: driver.read().t > before)


def test_a_drive_on_the_library_s_stack_is_connected_enabled_commanded_and_made_torque_free(
    meet: Callable[..., Met],
) -> None:
    driver, peer = meet()
    assert driver.connect() == Identity("�Servo #7", "", "0x0")  # a name in no encoding we know
    assert driver.read().counts == -123
    told = " ".join(driver.remarks)
    assert "tells no rated torque (6076h): 3 N·m is trusted" in told
    assert driver.watchdog.words == "", "no 1016h, no 1400h:5: nothing stops it when this program dies"
    driver.enable()
    assert peer.number(0x6041) == 0x27
    assert peer.number(0x6060) == 10
    peer.node.set_data(0x6064, 0, struct.pack("<i", 900))
    fresh(driver)
    assert driver.read().counts == 900
    assert driver.write(Torque(0.6)) == pytest.approx(0.6)
    until(lambda: peer.number(0x6071) == 200)  # per mille of 3 N·m
    assert driver.read().fault == ""
    assert driver.halt()
    assert peer.number(0x6041) == 0x40


@pytest.mark.parametrize(
    ("lacks", "remark"),
    [
        (0x1001, ""),
        (0x1008, ""),
        (0x1017, "has no heartbeat"),
        (0x1018, ""),
    ],
    ids=lambda x: f"{x:04X}h" if isinstance(x, int) else "",
)
def test_what_can_be_done_without_is_done_without_and_said(meet: Callable[..., Met], lacks: int, remark: str) -> None:
    driver, peer = meet(lacks)
    assert isinstance(driver.connect(), Identity)
    assert remark in " ".join(driver.remarks)
    driver.enable()
    assert peer.number(0x6041) == 0x27
    assert driver.halt()


@pytest.mark.parametrize(
    ("lacks", "why"),
    [
        (0x1000, "refused to read 1000h"),
        (0x1400, "there is no 6040h and no 6071h"),
        (0x1800, "there is no 6041h"),
        (0x6040, "refused 6040h:0"),
        (0x6041, "6041h"),
        (0x6060, "6060h"),
        (0x6061, r"does not tell its mode \(6061h\)"),
        (0x6064, r"does not tell its position \(6064h\)"),
        (0x6071, r"has no target torque \(6071h\)"),
        (0x6077, r"does not tell its torque \(6077h\)"),
    ],
    ids=lambda x: f"{x:04X}h" if isinstance(x, int) else "",
)
def test_what_it_cannot_be_run_without_is_named_in_a_sentence(meet: Callable[..., Met], lacks: int, why: str) -> None:
    driver, _ = meet(lacks)
    with pytest.raises(NotReady, match=why) as refused:
        driver.connect()
    assert f"drive (node {NODE} on CAN bus 'rig')" in str(refused.value)


def test_hdrig_devices_finds_it_with_what_it_tells_and_writes_a_bench_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    channel = f"library {next(CHANNELS)}"
    named, nameless = LibraryDrive(channel, 40), LibraryDrive(channel, 41, frozenset({0x1008, 0x1018, 0x1017}))
    file = tmp_path / "first.toml"
    try:
        assert main(["devices", "--interface", "virtual", "--channel", channel, "--write", str(file)]) == 0
    finally:
        named.close()
        nameless.close()
    said = capsys.readouterr().out
    assert "node 40  CiA 402: �Servo #7" in said
    assert "node 41  CiA 402: vendor 0x0 product 0x0" in said
    bench = read_bench(file.read_text(encoding="utf-8"), "first.toml")
    assert bench.devices.drive.type == "can.cia402"
    assert bench.hand is None, "no twin answered"
