"""The bus with its time: durations, order, load, cables."""

from __future__ import annotations

import pytest

from sim.wire.agenda import Agenda, Timer
from sim.wire.bus import Bus, Port
from sim.wire.frame import Frame
from sim.wire.tampers import Delay, Drop, Duplicate, Reorder, Resize

ALTERNATING = b"\x55" * 8  # with identifier 2AAh: 111 bits, nothing stuffed


class Wire:
    """A bus and two stations that note what they hear."""

    def __init__(self, bitrate: float = 1e6) -> None:
        self.agenda = Agenda()
        self.bus = Bus(self.agenda, bitrate)
        self.heard: list[tuple[float, str, int, bytes]] = []
        self.a, self.b, self.c = (self.station(name) for name in "abc")

    def station(self, name: str) -> Port:
        return self.bus.attach(name, lambda frame, t: self.heard.append((t, name, *frame)))

    def at_c(self) -> list[int]:
        """Identifiers in the order c heard them."""
        self.agenda.run_until(self.agenda.now + 0.1)
        return [identifier for _, name, identifier, _ in self.heard if name == "c"]


def test_a_frame_arrives_when_its_last_bit_has_passed_everywhere_but_at_its_sender() -> None:
    wire = Wire(bitrate=1e6)
    wire.a.send(Frame(0x2AA, ALTERNATING))
    wire.agenda.run_until(1.0)
    assert [(name, identifier) for _, name, identifier, _ in wire.heard] == [("b", 0x2AA), ("c", 0x2AA)]
    assert [t for t, *_ in wire.heard] == pytest.approx([111e-6, 111e-6])


def test_half_the_bit_rate_takes_twice_the_time() -> None:
    wire = Wire(bitrate=500e3)
    wire.a.send(Frame(0x2AA, ALTERNATING))
    wire.agenda.run_until(1.0)
    assert wire.heard[0][0] == pytest.approx(222e-6)


def test_the_lowest_identifier_goes_first_but_never_interrupts_a_frame() -> None:
    wire = Wire()
    wire.a.send(Frame(0x700))
    wire.agenda.run_until(10e-6)  # 700h has the bus
    wire.a.send(Frame(0x300))
    wire.b.send(Frame(0x100))
    wire.b.send(Frame(0x080))
    assert wire.at_c() == [0x700, 0x100, 0x080, 0x300]  # a station's own frames keep their order


def test_frames_follow_each_other_without_a_gap() -> None:
    wire = Wire()
    for _ in range(3):
        wire.a.send(Frame(0x2AA, ALTERNATING))
    wire.agenda.run_until(1.0)
    assert [t for t, name, *_ in wire.heard if name == "c"] == pytest.approx([111e-6, 222e-6, 333e-6])


def test_the_load_is_the_share_of_time_the_bus_is_busy() -> None:
    wire = Wire()
    for tick in range(1000):
        wire.agenda.at(tick * 1e-3, lambda: wire.a.send(Frame(0x2AA, ALTERNATING)))
    wire.agenda.run_until(1.0)
    assert wire.bus.load == pytest.approx(0.111, abs=0.001)


def test_a_bus_that_takes_no_time_delivers_at_once() -> None:
    wire = Wire(bitrate=float("inf"))
    wire.a.send(Frame(0x2AA, ALTERNATING))
    wire.agenda.run_until(0.0)
    assert wire.heard[0][0] == 0.0


def test_with_the_cable_out_frames_are_lost_both_ways() -> None:
    wire = Wire()
    wire.c.disconnect(keeps=False)
    wire.a.send(Frame(0x100))
    wire.c.send(Frame(0x200))
    assert wire.at_c() == []
    assert [identifier for _, name, identifier, _ in wire.heard if name == "b"] == [0x100]
    assert wire.c.lost == 1
    wire.c.reconnect()
    wire.a.send(Frame(0x101))
    assert wire.at_c() == [0x101]


def test_a_queue_that_keeps_frames_sends_the_old_ones_when_the_cable_is_back() -> None:
    wire = Wire()
    wire.a.disconnect(keeps=True)
    wire.a.send(Frame(0x201))
    wire.agenda.run_until(1.0)
    assert wire.heard == []
    wire.a.reconnect()
    assert wire.at_c() == [0x201]


@pytest.mark.parametrize(
    ("tamper", "sent", "heard"),
    [
        (Drop(0x181, 1), [0x181, 0x181, 0x182], [0x181, 0x182]),
        (Drop(None, 2), [0x181, 0x182, 0x183], [0x183]),
        (Duplicate(0x181, 1), [0x181, 0x182], [0x181, 0x181, 0x182]),
        (Delay(0x181, 0.01, 1), [0x181, 0x182], [0x182, 0x181]),
    ],
)
def test_tampering_acts_on_its_frames_as_often_as_it_was_told(tamper: Drop, sent: list[int], heard: list[int]) -> None:
    wire = Wire()
    wire.bus.tampers.append(tamper)
    for identifier in sent:
        wire.a.send(Frame(identifier))
    assert wire.at_c() == heard
    assert wire.bus.tampers == []


def test_reordering_swaps_neighbours_and_resizing_changes_lengths() -> None:
    wire = Wire()
    wire.bus.tampers.append(Reorder(0x181, 4))
    wire.bus.tampers.append(Resize(0x182, 2))
    for byte in range(4):
        wire.a.send(Frame(0x181, bytes([byte])))
    wire.a.send(Frame(0x182, b"\x01\x02\x03"))
    wire.at_c()
    assert [data.hex() for _, name, _, data in wire.heard if name == "c"] == ["01", "00", "03", "02", "0102"]


def test_a_timer_that_is_started_again_fires_once_and_late() -> None:
    agenda, fired = Agenda(), []
    timer = Timer(agenda, lambda: fired.append(agenda.now))
    timer.start(1.0)
    agenda.run_until(0.9)
    timer.start(1.0)
    agenda.run_until(1.5)
    assert fired == []
    agenda.run_until(5.0)
    assert fired == [1.9]
    timer.start(1.0)
    timer.start(0.25)
    agenda.run_until(9.0)
    assert fired == [1.9, 5.25]
    timer.start(1.0)
    timer.stop()
    agenda.run_until(20.0)
    assert len(fired) == 2
