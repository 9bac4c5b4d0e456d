"""The reader of a running run's ring."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from rig.core.ring import Ring
from rig.core.sample import Sample
from rig.live.tail import Tail

PRODUCER = """
import sys
from rig.core.ring import Ring
from rig.runfile.process import this_process
print(Ring.create(16, this_process()["started"]).path, flush=True)
sys.stdin.read()
"""


def put(ring: Ring, rows: range) -> None:
    """Rows whose every field is their number, kept by a recorder that keeps up."""
    for i in rows:
        assert ring.put(Sample(i, i, i, i, i, i, i, i, i, i, ""), i, i, i)
        ring.tell_acked(i + 1)


@pytest.fixture
def ring() -> Iterator[Ring]:
    ring = Ring.create(16)
    yield ring
    ring.unlink()
    ring.close()


def test_every_row_is_read_once_and_in_order(ring: Ring) -> None:
    tail, seen = Tail(ring.path), []
    for first in range(0, 60, 6):
        put(ring, range(first, first + 6))
        seen += list(tail.read()["counts_m"])
    assert seen == list(range(60))
    assert tail.skipped == 0
    assert len(tail.read()) == 0


def test_a_reader_that_was_too_slow_goes_on_with_what_is_left_and_says_how_much_it_missed(ring: Ring) -> None:
    tail = Tail(ring.path)
    put(ring, range(100))
    rows = tail.read()
    assert list(rows["counts_m"]) == list(range(100 - len(rows), 100))
    assert 0 < len(rows) < 16  # one place belongs to the row being made
    assert tail.skipped == 100 - len(rows)


def test_one_that_comes_late_begins_with_what_is_still_there_and_has_missed_nothing(ring: Ring) -> None:
    put(ring, range(100))
    tail = Tail(ring.path)
    rows = tail.read()
    assert rows["t"][-1] == 99.0
    assert tail.skipped == 0


def test_at_most_the_newest_rows_that_were_asked_for(ring: Ring) -> None:
    tail = Tail(ring.path)
    put(ring, range(10))
    assert list(tail.read(most=3)["counts_m"]) == [7, 8, 9]
    assert tail.skipped == 7


def test_a_reader_cannot_hold_up_the_producer(ring: Ring) -> None:
    tail = Tail(ring.path)
    put(ring, range(1000))  # the assertion is inside: every row found room
    assert tail.waiting == 1000


def test_what_was_put_before_the_end_is_read_after_it(ring: Ring) -> None:
    tail = Tail(ring.path)
    put(ring, range(5))
    assert not tail.closed
    ring.finish()
    assert tail.closed
    assert len(tail.read()) == 5


@pytest.mark.slow
def test_a_producer_that_was_killed_has_ended_too() -> None:
    with subprocess.Popen([sys.executable, "-c", PRODUCER], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as producer:
        assert producer.stdout is not None
        path = Path(producer.stdout.readline().decode().strip())
        tail = Tail(path)
        alive = tail.closed
        producer.send_signal(signal.SIGKILL)
    path.unlink()
    assert not alive
    assert tail.closed


def test_the_fields_are_those_of_the_ring(ring: Ring) -> None:
    tail = Tail(ring.path)
    put(ring, range(1))
    assert tail.read().dtype.names == tuple(tail.columns)
    assert np.float64 == tail.read().dtype["tau_l"]
