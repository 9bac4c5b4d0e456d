"""The drivers against nodes nobody here has built: every way to differ is handled and said, or refused in a sentence.

In real time on python-can's virtual bus; nothing here measures time.
"""

from __future__ import annotations

import struct
import time
from collections.abc import Callable, Iterator
from itertools import count
from typing import Any

import can
import pytest

from drivers.cia402 import Cia402
from drivers.cia404 import Cia404
from drivers.cia406 import Cia406
from drivers.wiring import Place, Wiring
from rig.core.clock import WallClock
from rig.core.errors import NotReady
from rig.core.sample import Torque
from tests.wire.foreign_node import NO_RTR, NO_SUCH_SUB, OFF, STATE, ForeignNode, Tpdo, Ways

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("patient")]
NODE = 23
CHANNELS = count()
ENCODER = {(0x1000, 0): b"\x96\x01\x08\x00", (0x6501, 0): struct.pack("<I", 4096), (0x6004, 0): bytes(4)}
TORQUE = {
    (0x1000, 0): b"\x94\x01\x02\x00",
    (0x6131, 1): b"\0\0\x56\0",
    (0x6132, 1): b"\x03",
    (0x9130, 1): struct.pack("<i", 2500),
}
DRIVE = {
    (0x1000, 0): b"\x92\x01\x02\x00",
    (0x6040, 0): b"\0\0",
    (0x6041, 0): b"\x40\0",
    (0x6060, 0): b"\0",
    (0x6061, 0): b"\0",
    (0x6064, 0): bytes(4),
    (0x6071, 0): b"\0\0",
    (0x6077, 0): b"\0\0",
}
POSITION = Tpdo(0x180 + NODE, 254, [0x60040020], timer=20)
STATUS = [Tpdo(0x180 + NODE, 1, [0x60410010, 0x60610008, 0x60770010]), Tpdo(0x280 + NODE, 1, [0x60640020])]
COMMAND = [Tpdo(0x200 + NODE, 255, [0x60400010, 0x60710010])]
OPEN: list[ForeignNode | Any] = []


@pytest.fixture(autouse=True)
def _closed() -> Iterator[None]:
    yield
    while OPEN:
        OPEN.pop().close()


def meet(
    kind: Callable[[Wiring, Place], Any], objects: dict[tuple[int, int], bytes], **more: Any
) -> tuple[Any, ForeignNode]:
    """A driver, and the node it is to talk to."""
    channel = f"foreign {next(CHANNELS)}"
    connect = lambda **_: can.Bus(interface="virtual", channel=channel)  # noqa: E731
    wiring = Wiring(WallClock(), {"rig": {"interface": "virtual", "channel": channel, "host_node": 127}}, connect)
    node = ForeignNode(channel, NODE, dict(objects), **more)
    role = {Cia402: "drive", Cia404: "torque_sensor", Cia406: "load_encoder"}[kind]  # type: ignore[index]
    numbers = {"counts_per_turn": 4096, "torque_rated": 3.0, "torque_limit": 5.0, "speed_limit": 62.8, "range": 50.0}
    numbers["following"] = 6.5
    driver = kind(wiring, Place(role, {"bus": "rig", "node": NODE}, period=0.001, **numbers))
    OPEN.extend((node, driver))
    return driver, node


def fresh(driver: Any) -> Any:
    """A reading after the next SYNC."""
    before, until = driver.read().t, time.monotonic() + 2.0
    while time.monotonic() < until:
        driver.bus.sync()
        time.sleep(0.005)
        if (reading := driver.read()).t > before:
            return reading
    raise AssertionError("nothing new after SYNC")


def told(driver: Any) -> str:
    return " ".join(driver.remarks)


def test_an_ordinary_encoder_is_mapped_to_sync_and_read() -> None:
    encoder, node = meet(Cia406, ENCODER, tpdos=[POSITION])
    encoder.connect()
    node.objects[0x6004, 0] = struct.pack("<I", 1024)
    assert fresh(encoder).counts == 1024
    assert node.number(0x1800, 2) == 1
    assert encoder.trouble == ""


def test_a_node_that_misses_the_first_sync_after_its_start_is_asked_again() -> None:
    encoder, node = meet(Cia406, ENCODER, tpdos=[POSITION], ways=Ways(missed=2))
    node.objects[0x6004, 0] = struct.pack("<I", 1024)
    encoder.connect()
    assert encoder.read().counts == 1024


def test_an_event_timer_from_the_factory_is_switched_off_and_its_frames_are_no_second_node() -> None:
    encoder, node = meet(
        Cia406, ENCODER, tpdos=[Tpdo(0x180 + NODE, 254, [0x60040020], timer=2)], ways=Ways(timer_too=True)
    )
    encoder.connect()
    assert node.number(0x1800, 5) == 0
    for _ in range(20):
        fresh(encoder)
    assert encoder.trouble == ""


@pytest.mark.parametrize("ways", [Ways(insists_on_no_rtr=True), Ways(shows_no_rtr=True)])
def test_bit_30_of_an_identifier_is_left_as_the_node_has_it(ways: Ways) -> None:
    encoder, node = meet(Cia406, ENCODER, tpdos=[Tpdo(0x180 + NODE | NO_RTR, 254, [0x60040020])], ways=ways)
    encoder.connect()
    assert node.number(0x1800, 1) == 0x180 + NODE | NO_RTR
    assert node.number(0x1800, 2) == 1
    assert "keeps its own PDOs" not in told(encoder)
    assert fresh(encoder).counts == 0


def test_a_pdo_of_29_bits_is_not_taken_for_one_of_11() -> None:
    extended = Tpdo(1 << 29 | 0x180 + NODE, 1, [0x60040020])
    encoder, _ = meet(Cia406, ENCODER, tpdos=[extended], ways=Ways(fixed_map=True))
    with pytest.raises(NotReady, match="no 6004h"):
        encoder.connect()


def test_a_mapping_that_can_only_be_read_is_decoded_as_it_is() -> None:
    both = Tpdo(0x180 + NODE, 1, [0x60300110, 0x60040020])
    encoder, node = meet(Cia406, {**ENCODER, (0x6030, 1): b"\x05\0"}, tpdos=[both], ways=Ways(fixed_map=True))
    encoder.connect()
    node.objects[0x6004, 0] = struct.pack("<I", 77)
    assert fresh(encoder).counts == 77
    assert "keeps its own PDOs" in told(encoder)


def test_a_sensor_that_tells_changes_only_is_given_a_timer_where_it_takes_one() -> None:
    ways = Ways(fixed_map=True, fixed_type=True)
    sensor, node = meet(Cia404, TORQUE, tpdos=[Tpdo(0x180 + NODE, 255, [0x91300120])], ways=ways)
    sensor.connect()
    assert 1 <= node.number(0x1800, 5) <= 2  # ms
    assert fresh(sensor).tau == pytest.approx(2.5)


def test_a_sensor_that_tells_changes_only_and_has_no_timer_is_refused() -> None:
    ways = Ways(fixed_map=True, fixed_type=True)
    sensor, node = meet(Cia404, TORQUE, tpdos=[Tpdo(0x180 + NODE, 255, [0x91300120])], ways=ways)
    del node.objects[0x1800, 5]
    with pytest.raises(NotReady, match=r"does it tell changes only\?"):
        sensor.connect()


def test_one_that_only_answers_a_sync_after_a_change_is_refused() -> None:
    ways = Ways(fixed_map=True, fixed_type=True)
    sensor, _ = meet(Cia404, TORQUE, tpdos=[Tpdo(0x180 + NODE, 0, [0x91300120])], ways=ways)
    with pytest.raises(NotReady, match=r"only after a change \(type 0\)"):
        sensor.connect()


def test_a_slow_starter_is_waited_for() -> None:
    encoder, _ = meet(Cia406, ENCODER, tpdos=[POSITION], ways=Ways(boot=0.7))
    encoder.connect()
    assert fresh(encoder).counts == 0


def test_a_node_that_is_not_there_is_one_sentence() -> None:
    encoder, _ = meet(Cia406, ENCODER, tpdos=[POSITION], ways=Ways(mute=True))
    with pytest.raises(NotReady, match=r"node 23 on CAN bus 'rig'\) does not answer"):
        encoder.connect()


def test_answers_of_another_length_than_the_standard_s_are_no_answers() -> None:
    encoder, _ = meet(Cia406, ENCODER, tpdos=[POSITION], ways=Ways(short_answers=True))
    with pytest.raises(NotReady, match="does not answer"):
        encoder.connect()


@pytest.mark.parametrize(("kind", "word"), [(b"\0\0\0\0", "CiA 0 device"), (b"\x92\x01\0\0", "CiA 402 device")])
def test_another_kind_of_device_is_refused(kind: bytes, word: str) -> None:
    encoder, _ = meet(Cia406, {**ENCODER, (0x1000, 0): kind}, tpdos=[POSITION])
    with pytest.raises(NotReady, match=word):
        encoder.connect()


def test_a_heartbeat_that_is_promised_and_not_sent_is_refused() -> None:
    encoder, _ = meet(Cia406, ENCODER, tpdos=[POSITION], ways=Ways(beats=False))
    with pytest.raises(NotReady, match="did not become operational; its heartbeat says nothing"):
        encoder.connect()


def test_a_node_that_knows_guarding_only_is_told_by_the_age_of_its_pdos() -> None:
    encoder, _ = meet(Cia406, ENCODER, tpdos=[POSITION], ways=Ways(heartbeat=False, guarding_only=True))
    encoder.connect()
    assert "only the age of its PDOs shows that it lives" in told(encoder)
    assert fresh(encoder).counts == 0
    assert encoder.trouble == ""


def test_an_emergency_of_the_start_that_was_taken_back_is_no_trouble_and_one_that_was_not_is_said() -> None:
    passing, _ = meet(Cia406, {**ENCODER, (0x1001, 0): b"\0"}, tpdos=[POSITION], ways=Ways(emergencies=(0x8130, 0)))
    passing.connect()
    fresh(passing)
    assert passing.trouble == ""
    assert "1001h" not in told(passing)
    lasting, _ = meet(Cia406, {**ENCODER, (0x1001, 0): b"\x09"}, tpdos=[POSITION], ways=Ways(emergencies=(0x5000,)))
    lasting.connect()
    assert "1001h = 09h" in told(lasting)


@pytest.mark.parametrize("aborts", [0x06020000, NO_SUCH_SUB, STATE, 0x08000000, 0x06040043, 0x05040001])
def test_a_bare_drive_is_walked_and_commanded_whatever_it_says_of_what_it_lacks(aborts: int) -> None:
    drive, node = meet(Cia402, DRIVE, tpdos=STATUS, rpdos=COMMAND, ways=Ways(aborts=aborts))
    drive.connect()
    assert drive.watchdog.words == "RPDO timeout of the drive, 100 ms, set and read back"  # no 1016h
    assert "6076h" in told(drive)
    drive.enable()
    assert node.objects[0x6041, 0] == b"\x27\0"
    fresh(drive)
    assert drive.write(Torque(0.6)) == pytest.approx(0.6)
    time.sleep(0.02)
    assert node.objects[0x6071, 0] == struct.pack("<h", 200)
    assert drive.halt()
    assert node.objects[0x6041, 0] == b"\x40\0"


def test_a_drive_that_watches_its_following_error_is_told_how_far_and_one_that_does_not_is_said_to() -> None:
    watching = {**DRIVE, (0x6065, 0): bytes(4), (0x6066, 0): bytes(2)}
    drive, node = meet(Cia402, watching, tpdos=STATUS, rpdos=COMMAND)
    drive.connect()
    assert (node.number(0x6065), node.number(0x6066)) == (4238, 50)  # 6.5 rad of 4096 counts a turn, upwards; ms
    bare, _ = meet(Cia402, DRIVE, tpdos=STATUS, rpdos=COMMAND)
    bare.connect()
    assert "has no following error window (6065h): in position mode this program alone watches" in told(bare)


def test_a_drive_without_anything_that_guards_it_says_so() -> None:
    drive, node = meet(Cia402, DRIVE, tpdos=STATUS, rpdos=COMMAND)
    del node.objects[0x1400, 5]
    drive.connect()
    assert drive.watchdog.words == ""


def test_a_mode_that_can_be_written_and_not_read_is_confirmed_by_6061h() -> None:
    drive, node = meet(Cia402, DRIVE, tpdos=STATUS, rpdos=COMMAND, ways=Ways(write_only=frozenset({(0x6060, 0)})))
    drive.connect()
    drive.enable()
    assert node.objects[0x6061, 0] == b"\x0a"


def test_a_drive_that_shows_its_mode_only_when_enabled_is_enabled_with_every_target_at_rest() -> None:
    targets = {(0x607A, 0): b"\x11\x22\0\0", (0x6064, 0): b"\x07\0\0\0", (0x60FF, 0): b"\1\0\0\0"}
    drive, node = meet(Cia402, {**DRIVE, **targets}, tpdos=STATUS, rpdos=COMMAND, ways=Ways(mode_when_enabled=True))
    drive.connect()
    drive.enable()
    assert node.objects[0x6061, 0] == b"\x0a"
    assert node.objects[0x607A, 0] == b"\x07\0\0\0"  # where it is: had it been in position mode it would have stayed
    assert node.objects[0x60FF, 0] == bytes(4)
    fresh(drive)
    assert drive.trouble == ""


def test_a_drive_that_stays_in_another_mode_is_not_enabled() -> None:
    drive, node = meet(Cia402, DRIVE, tpdos=STATUS, rpdos=COMMAND, ways=Ways(other_mode=8))
    drive.connect()
    with pytest.raises(NotReady, match="did not take torque mode: 6061h is 8, expected 10"):
        drive.enable()
    time.sleep(0.02)
    assert node.objects[0x6041, 0] == b"\x40\0"


def test_a_drive_whose_fixed_rpdo_is_off_is_not_commanded_through_it() -> None:
    off = [Tpdo(0x200 + NODE | OFF, 255, [0x60400010, 0x60710010])]
    drive, _ = meet(Cia402, {**DRIVE}, tpdos=STATUS, rpdos=off, ways=Ways(insists_on_no_rtr=True))
    with pytest.raises(NotReady, match="in the PDOs it takes of its own there is no 6040h"):
        drive.connect()


def test_a_torque_in_joules_or_without_unit_is_refused_and_a_code_of_the_makers_can_be_told() -> None:
    for code in (b"\0\0\x23\0", b"\0\0\0\0"):
        sensor, _ = meet(Cia404, {**TORQUE, (0x6131, 1): code}, tpdos=[Tpdo(0x180 + NODE, 1, [0x91300120])])
        with pytest.raises(NotReady, match="unit_code"):
            sensor.connect()
    sensor, _ = meet(Cia404, {**TORQUE, (0x6131, 1): b"\0\0\x23\0"}, tpdos=[Tpdo(0x180 + NODE, 1, [0x91300120])])
    sensor.place.options["unit_code"] = 0x00230000  # type: ignore[index]
    sensor.connect()
    assert fresh(sensor).tau == pytest.approx(2.5)
