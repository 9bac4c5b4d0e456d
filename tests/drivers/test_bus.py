"""Which SYNC a frame answers, by the adapter's time stamps where it has them."""

from __future__ import annotations

import os
from collections import deque
from typing import Any

import can
import pytest

from drivers.bus import MOST, Bus
from drivers.wiring import Place, Wiring
from rig.core.errors import NotReady
from sim.wire.frame import Frame
from tests.drivers.virtual import Wired, wired
from tests.fakes import FakeClock

EPOCH = 1.7e9  # s, what the adapter's time stamps begin at


class Adapter:
    """What waits is handed over at once."""

    def __init__(self) -> None:
        self.waiting: deque[can.Message] = deque()

    def send(self, message: can.Message) -> None:
        pass

    def recv(self, timeout: float) -> can.Message | None:
        return self.waiting.popleft() if self.waiting else None

    def shutdown(self) -> None:
        pass


@pytest.fixture
def made() -> tuple[Bus, Adapter, FakeClock]:
    clock, adapter = FakeClock(), Adapter()
    bus = Bus("rig", "", "", clock, {}, lambda **_: adapter)
    bus.open()
    return bus, adapter, clock


def answer(adapter: Adapter, stamp: float) -> None:
    adapter.waiting.append(can.Message(arbitration_id=0x181, data=b"\0" * 5, timestamp=stamp, is_extended_id=False))


def prompt(bus: Bus, adapter: Adapter, clock: FakeClock, apart: float) -> float:
    """One SYNC answered at once by an adapter whose clock is `apart` s from ours; when the answer was latched."""
    bus.sync()
    sent, clock.t = clock.t, clock.t + 0.0004
    answer(adapter, clock.t + apart)
    bus.drain()
    return bus.frames[0x181].latched - sent


def test_an_answer_belongs_to_the_sync_before_it(made: tuple[Bus, Any, FakeClock]):
    bus, adapter, clock = made
    clock.t = 0.9
    prompt(bus, adapter, clock, EPOCH)
    clock.t = 1.0
    bus.sync()
    clock.t = 1.0006
    answer(adapter, EPOCH + 1.0002)
    bus.drain()
    assert bus.frames[0x181].latched == 1.0
    assert bus.frames[0x181].arrived == pytest.approx(1.0002, abs=1e-6)


def test_an_answer_held_up_on_its_way_does_not_pass_for_one_to_the_sync_that_came_after(made):
    bus, adapter, clock = made
    clock.t = 0.9
    prompt(bus, adapter, clock, EPOCH)
    clock.t = 1.0
    bus.sync()
    clock.t = 1.022  # both sides stalled
    bus.sync()
    answer(adapter, EPOCH + 1.0004)
    bus.drain()
    assert bus.frames[0x181].latched == pytest.approx(1.0004, abs=1e-6)


@pytest.mark.parametrize("ppm", [-200.0, -50.0, 50.0, 200.0])  # crystals of adapters, and worse
def test_an_adapter_whose_crystal_drifts_from_the_host_s_makes_no_reading_old(made, ppm: float):
    bus, adapter, clock = made
    late = []
    for k in range(5000):  # 20 minutes, a SYNC every 240 ms
        clock.t = 1.0 + 0.24 * k
        late.append(prompt(bus, adapter, clock, EPOCH + 1e-6 * ppm * clock.t))
    assert set(late) == {0.0}


@pytest.mark.parametrize("step", [-3600.0, -0.4, 0.4, 3600.0])
def test_a_clock_that_is_set_in_a_run_makes_no_reading_old_and_none_older_than_the_one_before(made, step: float):
    bus, adapter, clock = made
    late = []
    for k in range(3000):
        clock.t = 1.0 + 0.001 * k
        late.append(prompt(bus, adapter, clock, EPOCH + step * (k > 1500)))
    assert set(late) == {0.0}


def test_a_frame_is_never_older_than_the_one_before_it_however_roughly_they_are_stamped(made):
    bus, adapter, clock = made
    arrived = []
    for k in range(500):
        clock.t = 1.0 + 0.001 * k
        answer(adapter, EPOCH + round(clock.t, 2))  # in steps of 10 ms: by the stamps, the later may be the older
        bus.drain()
        arrived.append(bus.frames[0x181].arrived)
    assert arrived == sorted(arrived)


@pytest.mark.parametrize("stamp", [0.0, 12.5, EPOCH + 5000.0])
def test_time_stamps_of_another_clock_are_not_looked_at(made, stamp: float):
    bus, adapter, clock = made
    clock.t = 1.0
    bus.sync()
    clock.t = 1.0006
    answer(adapter, stamp)
    bus.drain()
    assert bus.frames[0x181].latched == 1.0
    assert bus.frames[0x181].arrived == 1.0006


@pytest.mark.parametrize(
    ("interface", "given", "passed"),
    [("slcan", {}, {"timeout": 0.0}), ("slcan", {"timeout": 0.002}, {"timeout": 0.002}), ("socketcan", {}, {})],
)
def test_a_serial_adapter_is_never_waited_for_unless_the_bench_says_so(
    interface: str, given: dict[str, float], passed: dict[str, float]
):
    """python-can's slcan waits 1 ms at every look at an empty line unless told otherwise: four times a tick."""
    asked: dict[str, Any] = {}
    sections = {"rig": {"interface": interface, "channel": "x", "options": given}}
    wiring = Wiring(FakeClock(), sections, lambda **options: asked.update(options))
    wiring.bus(Place("drive", {"bus": "rig"})).open()
    assert {key: value for key, value in asked.items() if key not in ("interface", "channel")} == passed


def test_a_bus_that_another_host_commands_through_another_adapter_is_refused():
    w = wired()
    other = w.twin.bus.attach("another host", lambda frame, t: None)

    def beat() -> None:  # as an idle console does
        other.send(Frame(0x77F, b"\x05"))
        w.twin.agenda.after(0.05, beat)

    beat()
    heard = frames_of(w)
    with pytest.raises(NotReady, match=r"has a host already: .* heartbeat of node 127"):
        w.instruments.connect()
    assert {frame.identifier for frame in heard if frame.identifier < 0x80} == set()  # no node was told anything
    assert not [frame for frame in heard if 0x600 < frame.identifier < 0x680]  # nor asked


def test_heartbeats_an_adapter_kept_from_before_keep_nobody_off():
    w = wired()
    gone = w.twin.bus.attach("gone", lambda frame, t: None)

    def connect(**options: Any) -> Any:
        made = w.wire.connect(**options)
        gone.send(Frame(0x77F, b"\x05"))  # waits before anybody looks
        return made

    again = w.bench.wired(w.wire, connect=connect)
    assert again.connect()
    again.close()


def frames_of(w: Wired) -> list[Frame]:
    """Every frame that passes from now on."""
    heard: list[Frame] = []
    w.twin.bus.attach("ear", lambda frame, t: heard.append(frame))
    return heard


class Confirming(Adapter):
    """As python-can's slcan: nothing is handed over, once, for the word that confirms a frame of ours."""

    def __init__(self) -> None:
        super().__init__()
        self.sight, self.bytes = os.pipe()

    def arrive(self, *words: can.Message | None) -> None:
        for word in words:
            self.waiting.append(word)  # type: ignore[arg-type]
            os.write(self.bytes, b"\r")

    def recv(self, timeout: float) -> can.Message | None:
        if self.waiting:
            os.read(self.sight, 1)
        return super().recv(timeout)

    def fileno(self) -> int:
        return self.sight


def test_answers_behind_the_words_of_a_serial_adapter_are_taken_at_once():
    adapter = Confirming()
    bus = Bus("rig", "", "", FakeClock(), {}, lambda **_: adapter)
    bus.open()
    answers = [can.Message(arbitration_id=number, data=b"\0", is_extended_id=False) for number in (0x181, 0x281)]
    adapter.arrive(None, answers[0], None, None, answers[1])
    bus.drain()
    assert set(bus.frames) == {0x181, 0x281}


def test_a_serial_adapter_that_is_gone_does_not_keep_the_loop():
    adapter = Confirming()
    bus = Bus("rig", "", "", FakeClock(), {}, lambda **_: adapter)
    bus.open()
    os.close(adapter.bytes)  # there is always something to be read: its end
    looks: list[float] = []
    adapter.recv = lambda timeout: looks.append(timeout)  # type: ignore[assignment]
    bus.drain()
    assert len(looks) <= MOST
