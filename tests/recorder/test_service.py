"""What the recorder's process does, on a clock of the test's own."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from rig.core.ring import Ring
from rig.recorder.service import FLUSH, POLL, SYNC, Service
from rig.runfile.columns import schema
from rig.runfile.journal import JournalReader, JournalWriter
from tests.runfile.rows import assert_prefix, new_folder, sample

LOST_BY_A_KILL = 0.5  # s, promised
LOST_BY_A_POWER_CUT = 1.0


class Rig:
    """A producer of one row a millisecond and a recorder that is looked in on every POLL."""

    def __init__(self, root: Path, capacity: int = 65_536) -> None:
        self.folder = new_folder(root)
        self.ring = Ring.create(capacity)
        self.journal = JournalWriter(self.folder, schema("sim"), 0)
        self.service = Service(self.ring, self.journal, 0.0)
        self.now = 0.0

    def live(self, seconds: float, step: float = POLL) -> Iterator[None]:
        """Let time pass; yields just before each look of the recorder, when it is furthest behind."""
        until = self.now + seconds
        while self.now < until:
            self.now += step
            while self.ring.head <= self.now * 1000:
                self.ring.put(*sample(self.ring.head))
            yield
            self.service.step(self.now)


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[Rig]:
    rig = Rig(tmp_path)
    yield rig
    rig.ring.unlink()
    rig.ring.close()


@pytest.mark.slow
def test_a_kill_at_any_moment_finds_all_but_the_last_half_second_in_the_file(rig: Rig) -> None:
    for _ in rig.live(5.0):
        in_file = JournalReader(rig.folder)
        assert sum(batch.num_rows for batch in in_file) == rig.ring.written
        assert (rig.ring.head - rig.ring.written) * 1e-3 <= FLUSH + 2 * POLL < LOST_BY_A_KILL


def test_a_power_cut_at_any_moment_finds_all_but_the_last_second_on_disk(rig: Rig) -> None:
    for _ in rig.live(5.0):
        assert (rig.ring.head - rig.ring.acked) * 1e-3 <= SYNC + 2 * POLL < LOST_BY_A_POWER_CUT


def test_nothing_is_acknowledged_before_it_is_synced(rig: Rig, monkeypatch: pytest.MonkeyPatch) -> None:
    synced = []
    monkeypatch.setattr(rig.journal, "sync", lambda: synced.append(rig.journal.rows))
    for _ in rig.live(3.0):
        assert rig.ring.acked <= (synced[-1] if synced else 0)
    assert rig.ring.acked > 2000


@pytest.mark.slow
def test_a_producer_faster_than_time_is_followed_by_how_full_the_ring_is(tmp_path: Path) -> None:
    rig, put = Rig(tmp_path, capacity=1000), 0
    for _ in range(50):  # 250 rows a look, and no time passes at all
        put += sum(rig.ring.put(*sample(put + i)) for i in range(250))
        assert rig.service.pressed
        rig.service.step(0.0)
    assert put == rig.ring.acked == 12_500
    rig.service.finish()
    assert_prefix(rig.folder, put)
    rig.ring.unlink()
    rig.ring.close()


def test_finishing_brings_every_row_to_disk(rig: Rig) -> None:
    for _ in rig.live(0.35):
        pass
    assert rig.ring.written < rig.ring.head
    rig.service.finish()
    assert rig.ring.acked == rig.ring.written == rig.ring.head
    assert_prefix(rig.folder, rig.ring.head)


def test_a_restarted_recorder_goes_on_where_the_journal_ends(rig: Rig) -> None:
    for _ in rig.live(0.5):
        pass
    second = JournalWriter(rig.folder, schema("sim"), rig.ring.written)
    Service(rig.ring, second, rig.now).finish()
    assert second.path.name == "journal-0002.arrows"
    assert_prefix(rig.folder, rig.ring.head)


def test_a_batch_the_disk_refuses_leaves_the_file_as_it_was(rig: Rig, monkeypatch: pytest.MonkeyPatch) -> None:
    for _ in rig.live(0.5):
        pass
    before, rows = rig.journal.path.read_bytes(), rig.ring.written

    def half_then_full(handle: int, data: bytes) -> None:

        os.write(handle, data[: len(data) // 2])
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("rig.runfile.journal._write_all", half_then_full)
    with pytest.raises(OSError, match="No space"):
        rig.service.step(rig.now + 10.0)
    assert rig.journal.path.read_bytes() == before
    assert rig.ring.written == rows


def test_what_was_not_measured_is_null_in_the_journal_and_never_zero(rig: Rig) -> None:
    for _ in rig.live(0.5):
        pass
    (batch, *_) = JournalReader(rig.folder)
    torque, counts = batch.column("tau_l"), batch.column("counts_l")
    assert [i for i, valid in enumerate(torque.is_valid().to_pylist()) if not valid] == list(range(3, len(batch), 7))
    assert [i for i, valid in enumerate(counts.is_valid().to_pylist()) if not valid] == list(range(5, len(batch), 11))
    assert not np.isnan(torque.drop_null().to_numpy()).any()
