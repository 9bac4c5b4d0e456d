"""The line between station and web process: nobody waits for anybody."""

from __future__ import annotations

import socket
from collections.abc import Iterator

import pytest

from rig.station.channel import KEPT, Channel


@pytest.fixture
def ends() -> Iterator[tuple[Channel, Channel]]:
    a, b = (Channel(end) for end in socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET))
    yield a, b
    a.close()
    b.close()


def test_what_is_posted_arrives_in_order(ends: tuple[Channel, Channel]) -> None:
    ours, theirs = ends
    for k in range(5):
        ours.post({"k": k, "text": "θ̃ \ud800"})
    assert [m["k"] for m in theirs.receive(1.0)] == [0, 1, 2, 3, 4]


def test_a_reader_who_sleeps_makes_nobody_wait_and_loses_only_what_was_offered(ends: tuple[Channel, Channel]) -> None:
    ours, theirs = ends
    ours.post({"first": True})
    while ours.offer({"progress": "x" * 1000}):
        pass
    ours.post({"kept": True})
    assert not ours.offer({"progress": "late"})
    assert ours.dropped == 2
    got = theirs.receive()
    assert got[0] == {"first": True}
    ours.flush()
    assert theirs.receive() == [{"kept": True}]


def test_a_reader_who_never_wakes_costs_bounded_memory(ends: tuple[Channel, Channel]) -> None:
    ours, _ = ends
    for k in range(3 * KEPT):
        ours.post({"k": k})
    assert len(ours._waiting) == KEPT


def test_a_dead_reader_is_known_and_hurts_nobody(ends: tuple[Channel, Channel]) -> None:
    ours, theirs = ends
    theirs.close()
    ours.post({"k": 1})
    assert ours.closed
    assert ours.receive(0.1) == []
    assert ours.offer({"k": 2})
