"""The ring of samples in shared memory."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.core.channels import CHANNELS
from rig.core.errors import RecorderError
from rig.core.ring import HEADER, Ring
from rig.core.sample import Sample

HOLDER = """
import sys, time
from rig.core.ring import Ring
from rig.core.sample import Sample
ring = Ring.create(64)
for i in range(40):
    ring.put(Sample(i, i, i, i, i, i, i, i, i, i, ""), i, i, i)
print(ring.path, flush=True)
time.sleep(60)
"""
HAMMERED = 40_000  # rows
HAMMER = """
import sys
from rig.core.ring import Ring
from rig.core.sample import Sample
ring = Ring.create(256)
print(ring.path, flush=True)
for i in range(int(sys.argv[1])):
    while not ring.put(Sample(i, i, i, i, i, i, i, i, i, i, ""), i, i, i):
        pass
sys.stdin.read()
"""


def row(i: int) -> tuple[Sample, float, float, float]:
    """Every field holds `i`: a row torn between two would show."""
    return Sample(i, i, i, i, i, i, i, i, i, i, ""), i, i, i


@pytest.fixture
def ring() -> Iterator[Ring]:
    ring = Ring.create(16)
    yield ring
    ring.unlink()
    ring.close()


def test_what_is_put_is_read_back_with_every_channel_in_its_place(ring: Ring) -> None:
    kept = Sample(0.001, 1.0, 2.0, 3.0, 4.0, 5.0, 6e-5, 7, 8, 9, "")
    assert ring.put(kept, 0.5, 0.25, 1.5)
    (got,) = ring.read(0, 1)
    assert got.dtype.names == tuple(c.name for c in CHANNELS)
    assert got.tolist() == (0.001, 1.0, 2.0, 3.0, 4.0, 5.0, 0.5, 0.25, 1.5, 6e-5, 7, 8, 9)


def test_a_full_ring_takes_no_row_until_the_recorder_gives_room_back(ring: Ring) -> None:
    assert all(ring.put(*row(i)) for i in range(16))
    assert not ring.put(*row(16))
    ring.tell_acked(1)
    assert ring.put(*row(16))
    assert not ring.put(*row(17))
    assert ring.read(1, 17)["t"].tolist() == list(range(1, 17))


def test_a_reader_that_was_too_slow_gets_only_rows_that_are_whole(ring: Ring) -> None:
    for i in range(40):
        ring.tell_acked(i)
        ring.put(*row(i))
    assert ring.read(0, 40)["t"].tolist() == list(range(25, 40))  # row 24 may be the one being overwritten


def test_rows_that_are_not_there_yet_are_left_out(ring: Ring) -> None:
    ring.put(*row(0))
    assert len(ring.read(0, 10)) == 1
    assert len(ring.read(5, 10)) == 0


@pytest.mark.slow
@given(
    st.integers(1, 9),
    st.lists(st.tuples(st.integers(0, 12), st.integers(0, 12)), max_size=30),
)
def test_whoever_follows_with_acks_misses_no_row_and_sees_none_twice(
    capacity: int, turns: list[tuple[int, int]]
) -> None:
    ring, put, seen = Ring.create(capacity), 0, []
    try:
        for puts, reads in turns:
            for _ in range(puts):
                put += ring.put(*row(put))
            got = ring.read(len(seen), len(seen) + reads)
            seen += got["counts_m"].tolist()
            ring.tell_acked(len(seen))
        seen += ring.read(len(seen), ring.head)["counts_m"].tolist()
        assert ring.head == put
        assert seen == list(range(put))
    finally:
        ring.unlink()
        ring.close()


def test_it_survives_the_death_of_every_process() -> None:
    with subprocess.Popen([sys.executable, "-c", HOLDER], stdout=subprocess.PIPE, text=True) as holder:
        assert holder.stdout is not None
        path = Path(holder.stdout.readline().strip())
        holder.send_signal(signal.SIGKILL)
    ring = Ring.attach(path)
    try:
        assert ring.producer_pid == holder.pid
        assert ring.read(0, 100)["theta_ref"].tolist() == list(range(40))
        assert not ring.closed
    finally:
        ring.unlink()
        ring.close()


@pytest.mark.slow
def test_a_reader_beside_a_producer_at_full_speed_sees_no_torn_row() -> None:
    command = [sys.executable, "-c", HAMMER, str(HAMMERED)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as hammer:
        assert hammer.stdout is not None
        ring = Ring.attach(Path(hammer.stdout.readline().strip()), writable=True)
        seen = 0
        while seen < HAMMERED:
            got = ring.read(seen, ring.head)
            index = np.arange(seen, seen + len(got))
            for name in ("t", "tau_l", "flags"):  # first, middle and last field of the row
                np.testing.assert_array_equal(got[name], index)
            seen += len(got)
            ring.tell_acked(seen)
        hammer.communicate("")
        ring.unlink()
        ring.close()


def test_the_recorders_sentence_reaches_the_loop_whole_or_cut_to_fit(ring: Ring) -> None:
    other = Ring.attach(ring.path, writable=True)
    other.tell_error(28, "the disk of /runs is full: 0 bytes left – ask the lab’s keeper")
    assert ring.error == "the disk of /runs is full: 0 bytes left – ask the lab’s keeper"
    other.tell_error(28, "ä" * 2000)
    assert 500 < len(ring.error) < 520
    other.tell_reader(7, 8)
    assert (ring.error, ring.reader) == ("", (7, 8))
    other.close()


def test_a_mere_reader_cannot_write(ring: Ring) -> None:
    other = Ring.attach(ring.path)
    with pytest.raises(TypeError):
        other.tell_acked(1)
    other.close()


def test_rows_begin_on_a_page_of_their_own_and_fields_are_aligned(ring: Ring) -> None:
    ring.put(*row(3))
    raw = ring.path.read_bytes()
    assert len(raw) == HEADER + 16 * 8 * len(CHANNELS)
    assert np.frombuffer(raw, np.float64, count=10, offset=HEADER).tolist() == [3.0] * 10


@pytest.mark.parametrize("content", [b"", b"not a ring", bytes(8192), b"hdrigRNG" + bytes(8192)])
def test_a_file_that_is_no_ring_is_refused_with_a_sentence(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "x.ring"
    path.write_bytes(content)
    with pytest.raises(RecorderError, match="ring"):
        Ring.attach(path)


def test_a_ring_that_is_not_there_is_refused_with_its_path(tmp_path: Path) -> None:
    with pytest.raises(RecorderError, match=r"gone\.ring is not a ring of samples: .*No such file"):
        Ring.attach(tmp_path / "gone.ring")


def test_a_ring_with_other_columns_is_refused(ring: Ring, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rig.core.ring.CHANNELS", CHANNELS[:-1])
    with pytest.raises(RecorderError, match="other columns"):
        Ring.attach(ring.path)


def test_without_shared_memory_it_takes_a_temporary_file(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("rig.core.ring.SHARED", "/nonexistent")
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    ring = Ring.create(4)
    assert ring.path.parent == tmp_path
    ring.close()


def test_no_room_anywhere_is_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rig.core.ring.SHARED", "/nonexistent")
    monkeypatch.setattr("tempfile.tempdir", "/proc")
    with pytest.raises(RecorderError, match=r"no room for 6\.8 MB of shared memory \(/nonexistent: .*; /proc: "):
        Ring.create()
