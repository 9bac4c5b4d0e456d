"""The loop's end of the recorder, with its real process."""

from __future__ import annotations

import errno
import os
import resource
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from rig.core.errors import RecorderError, UsageError
from rig.core.ring import Ring
from rig.recorder import Recorder
from rig.runfile.finalise import finalise
from rig.runfile.recover import recover
from rig.runfile.run import Run
from tests.recorder.clocks import HeldClock, WallClock
from tests.runfile.rows import assert_prefix, copy_of, manifest_of, new_folder, sample


def put(recorder: Recorder, start: int, stop: int) -> None:
    """Rows by their index."""
    for i in range(start, stop):
        recorder.put(*sample(i))


def until(seen: Callable[[], bool]) -> None:
    """Wait for the other process; a test that hangs here is a test that failed."""
    while not seen():
        time.sleep(0.005)


def pid_of(recorder: Recorder) -> int:
    """The recorder's process."""
    ring = Ring.attach(recorder.ring)
    try:
        return ring.reader[0]
    finally:
        ring.close()


def raised(recorder: Recorder) -> str:
    """The sentence `check` ends the run with, once the process is gone."""
    while True:
        try:
            recorder.check()
        except RecorderError as error:
            return str(error)
        time.sleep(0.005)


@contextmanager
def no_file_beyond(size: int) -> Iterator[None]:
    """As on a full disk: for processes started inside, no file grows beyond `size` bytes."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.mark.slow
def test_every_row_put_is_in_the_run(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    recorder = Recorder(folder, WallClock())
    recorder.start()
    put(recorder, 0, 5000)
    recorder.check()
    assert recorder.close() == recorder.close() == 5000
    assert not recorder.ring.exists()
    assert_prefix(folder, 5000)


@pytest.mark.slow
def test_a_run_without_a_row_is_a_run_without_a_row(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    recorder = Recorder(folder, WallClock())
    recorder.start()
    assert recorder.close() == 0
    assert finalise(folder, "stopped", "before the first tick").rows == 0


def test_closing_before_starting_leaves_nothing_behind(tmp_path: Path) -> None:
    recorder = Recorder(new_folder(tmp_path), WallClock())
    assert recorder.close() == 0
    assert not recorder.ring.exists()


@pytest.mark.slow
def test_virtual_time_is_held_while_the_recorder_catches_up(tmp_path: Path) -> None:
    folder, clock = new_folder(tmp_path), HeldClock()
    recorder = Recorder(folder, clock, capacity=256)
    recorder.start()
    put(recorder, 0, 4000)
    assert recorder.close() == 4000
    assert clock.held > 0
    assert_prefix(folder, 4000)


@pytest.mark.slow
def test_wall_time_cannot_be_held_and_a_full_ring_ends_the_run(tmp_path: Path) -> None:
    recorder = Recorder(new_folder(tmp_path), WallClock(), capacity=100)
    recorder.start()
    os.kill(pid_of(recorder), signal.SIGSTOP)
    try:
        with pytest.raises(RecorderError, match="the recorder is 100 rows behind, as many as can wait"):
            put(recorder, 0, 101)
    finally:
        os.kill(pid_of(recorder), signal.SIGCONT)
    assert recorder.close() == 100


@pytest.mark.slow
def test_a_killed_recorder_is_noticed_and_nothing_is_lost(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    recorder = Recorder(folder, WallClock())
    recorder.start()
    put(recorder, 0, 700)
    os.kill(pid_of(recorder), signal.SIGKILL)
    assert "the recorder died (killed by signal 9)" in raised(recorder)
    put(recorder, 700, 800)  # the rows of a stop that takes its time
    assert recorder.close() == 800
    assert_prefix(folder, 800)


@pytest.mark.slow
def test_a_killed_recorder_ends_a_run_in_held_time_too(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    recorder = Recorder(folder, HeldClock(), capacity=64)
    recorder.start()
    os.kill(pid_of(recorder), signal.SIGKILL)
    with pytest.raises(RecorderError, match="died"):
        put(recorder, 0, 65)
    assert recorder.close() == 64
    assert_prefix(folder, 64)


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT])
def test_signals_meant_for_the_whole_program_do_not_reach_it(tmp_path: Path, number: signal.Signals) -> None:
    folder = new_folder(tmp_path)
    recorder = Recorder(folder, WallClock())
    recorder.start()
    pid = pid_of(recorder)
    assert os.getpgid(pid) != os.getpgid(0)
    os.kill(pid, number)
    put(recorder, 0, 100)
    assert recorder.close() == 100
    assert_prefix(folder, 100)


@contextmanager
def real_time() -> Iterator[None]:
    """As the loop of a real rig."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
    except PermissionError:
        pytest.skip("this user may not schedule in real time")
    try:
        yield
    finally:
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


@pytest.mark.slow
def test_it_runs_at_normal_priority_even_under_a_real_time_loop(tmp_path: Path) -> None:
    recorder = Recorder(new_folder(tmp_path), WallClock())
    with real_time():
        recorder.start()
        assert os.sched_getscheduler(0) == os.SCHED_FIFO
        assert os.sched_getscheduler(pid_of(recorder)) == os.SCHED_OTHER
    recorder.close()


@pytest.mark.slow
def test_a_full_disk_is_told_to_the_loop_and_room_made_in_time_keeps_every_row(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    recorder = Recorder(folder, WallClock())
    with no_file_beyond(30_000):
        recorder.start()
    put(recorder, 0, 2000)
    sentence = raised(recorder)
    assert f"the recorder cannot write {folder}" in sentence
    assert "File too large" in sentence
    assert recorder.close() == 2000  # there is room again: a second recorder starts
    assert_prefix(folder, 2000)


@pytest.mark.slow
def test_a_disk_that_stays_full_leaves_the_rows_in_memory_and_says_where(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    recorder = Recorder(folder, WallClock())
    with no_file_beyond(30_000):
        recorder.start()
        put(recorder, 0, 2000)
        raised(recorder)
        with pytest.raises(RecorderError, match=rf"the last \d+ in {recorder.ring}; .*hdrig recover {folder}"):
            recorder.close()
    assert recorder.ring.exists()
    told = recover(folder)
    assert told.rows == 2000
    assert "from shared memory" in told.sentence
    assert_prefix(folder, 2000)
    assert not recorder.ring.exists()


def test_a_folder_that_cannot_be_written_is_told_before_anything_moves(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    recorder = Recorder(folder, WallClock())
    with (
        no_file_beyond(2000),  # enough for the manifest, not for a journal's first block
        pytest.raises(RecorderError, match=f"the recorder cannot write {folder}.*File too large"),
    ):
        recorder.start()
    assert not recorder.ring.exists()
    assert not list(folder.glob("journal*"))


def test_a_folder_that_is_not_there_is_told_before_anything_moves(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "gone", WallClock())
    with pytest.raises(UsageError, match="gone is not a run folder"):
        recorder.start()
    assert not recorder.ring.exists()


def test_a_read_only_folder_is_told_before_anything_moves(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = new_folder(tmp_path)
    recorder = Recorder(folder, WallClock())

    def read_only(path: Path, data: bytes) -> None:
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr("rig.runfile.manifest.write_atomic", read_only)  # tests may run as root, whom no mode stops
    with pytest.raises(RecorderError, match=f"samples cannot be kept in {folder}: Read-only file system"):
        recorder.start()
    assert not recorder.ring.exists()


@pytest.mark.slow
def test_two_recorders_never_write_one_run(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    first, second = Recorder(folder, WallClock()), Recorder(folder, WallClock())
    first.start()
    with pytest.raises(RecorderError, match="written by another process"):
        second.start()
    put(first, 0, 10)
    assert first.close() == 10


@pytest.mark.slow
def test_while_it_runs_the_manifest_says_where_the_rows_are(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    recorder = Recorder(folder, WallClock())
    recorder.start()
    assert manifest_of(folder)["ring"] == str(recorder.ring)
    recorder.close()
    finalise(folder, "completed", "the procedure came to its end")
    assert "ring" not in manifest_of(folder)


@pytest.mark.slow
def test_the_run_can_be_read_while_it_is_made(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    recorder = Recorder(folder, WallClock())
    recorder.start()
    put(recorder, 0, 300)
    ring = Ring.attach(recorder.ring)
    until(lambda: ring.written == 300)
    assert Run.open(folder).rows == 300
    assert len(ring.read(0, 300)) == 300
    ring.close()
    recorder.close()


@contextmanager
def stopped(recorder: Recorder) -> Iterator[None]:
    """Its process stands still, as one whose disk is stuck."""
    os.kill(pid_of(recorder), signal.SIGSTOP)
    try:
        yield
    finally:
        os.kill(pid_of(recorder), signal.SIGCONT)


@pytest.mark.slow
def test_held_time_does_not_wait_for_ever(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rig.recorder.recorder.STUCK", 0.2)
    recorder = Recorder(new_folder(tmp_path), HeldClock(), capacity=64)
    recorder.start()
    with stopped(recorder), pytest.raises(RecorderError, match=r"has kept none for 0 s; the disk of .* is stuck"):
        put(recorder, 0, 65)
    assert recorder.close() == 64


@pytest.mark.slow
def test_an_operator_who_wants_an_end_need_not_wait_so_long(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rig.recorder.recorder.STUCK_WHEN_ASKED", 0.2)
    recorder = Recorder(new_folder(tmp_path), HeldClock(), capacity=64, interrupted=lambda: True)
    recorder.start()
    with stopped(recorder), pytest.raises(RecorderError, match="the recorder's process was stopped"):
        put(recorder, 0, 65)
    assert recorder.close() == 64


@pytest.mark.slow
def test_rows_in_memory_that_somebody_removed_are_told_as_lost(tmp_path: Path) -> None:
    recorder = Recorder(new_folder(tmp_path), WallClock())
    recorder.start()
    with stopped(recorder):
        put(recorder, 0, 100)
        os.kill(pid_of(recorder), signal.SIGKILL)
    recorder.ring.unlink()
    assert "100 more are lost: somebody removed" in raised(recorder)
    with pytest.raises(RecorderError, match="0 of 100 rows are in the journal, the last 100 are lost"):
        recorder.close()


@pytest.mark.slow
def test_a_journal_removed_in_mid_run_is_told_and_what_is_in_memory_is_kept(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    recorder = Recorder(folder, WallClock(), capacity=1000)
    recorder.start()
    ring = Ring.attach(recorder.ring)
    put(recorder, 0, 900)
    until(lambda: ring.acked == 900)
    put(recorder, 900, 1100)
    (folder / "journal-0001.arrows").unlink()
    assert "somebody removed or cut it" in raised(recorder)
    with pytest.raises(RecorderError, match=r"\d+ of 1100 rows are lost: a journal was removed or cut"):
        recorder.close()
    done = finalise(folder, "completed", "end", expected_rows=1100)
    assert done.lost == 1100 - done.rows > 0
    assert manifest_of(folder)["status"] == "interrupted"
    ring.close()


@pytest.mark.slow
def test_the_rows_of_a_run_are_not_taken_by_its_copy(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    recorder = Recorder(folder, WallClock())
    recorder.start()
    put(recorder, 0, 100)
    copy = copy_of(folder, tmp_path / "copy")
    before = {p.name: p.read_bytes() for p in copy.iterdir()}
    with pytest.raises(UsageError, match=f"belong to {folder}, of which {copy} is a copy"):
        recover(copy)
    assert {p.name: p.read_bytes() for p in copy.iterdir()} == before
    assert recorder.ring.exists()
    assert recorder.close() == 100


def test_the_rows_of_a_run_that_was_moved_are_still_its_own(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    ring = Ring.create(10, folder=folder)
    moved = folder.rename(tmp_path / "moved")
    assert ring.owner == str(folder)
    assert ring.belongs_to(moved)
    ring.unlink()
    ring.close()
