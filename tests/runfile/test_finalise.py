"""Closing a run in steps, killed between any two of them, and recovered."""

from __future__ import annotations

import json
import os
import stat
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.core.errors import DataError, NotReady, UsageError
from rig.core.ring import Ring
from rig.runfile import manifest
from rig.runfile.events import EventLog, read_events
from rig.runfile.finalise import StepHook, add_derived, finalise
from rig.runfile.process import sole_writer, started, this_process
from rig.runfile.recover import recover
from rig.runfile.verify import verify
from tests.runfile.rows import assert_prefix, copy_of, manifest_of, new_folder, ring_of, write_journal

STEPS = ("claim", "drain", "archive", "timing", "hash", "protect", "status")  # of a run that is closed, in order
REPOSITORY = Path(__file__).parents[2]
CLOSER = """
import os, signal, sys
from pathlib import Path
from rig.runfile.finalise import finalise
from rig.runfile.recover import recover

def kill(name):
    if name == sys.argv[2]:
        os.kill(os.getpid(), signal.SIGKILL)

if sys.argv[3] == "finalise":
    finalise(Path(sys.argv[1]), "completed", "the procedure came to its end", timing={"missed": 0}, step=kill)
else:
    recover(Path(sys.argv[1]), step=kill)
"""


class Killed(BaseException):
    """Stands in for a kill where a process of its own for each case would take too long."""


def killer(step: str) -> StepHook:
    """Ends whatever is being done just before `step`."""

    def hook(name: str) -> None:
        if name == step:
            raise Killed

    return hook


def killed_at(folder: Path, step: str, act: str) -> None:
    """Close or recover `folder` in a process that kills itself just before `step`."""
    code = subprocess.run([sys.executable, "-c", CLOSER, str(folder), step, act], cwd=REPOSITORY, check=False)
    assert code.returncode == -9


def dead_run(root: Path, rows: int = 500, in_journal: int = 330) -> Path:
    """A run whose program and recorder were killed: a torn journal, and a ring that still has the rest."""
    ring = ring_of(rows)
    ring.close()
    folder = new_folder(root, ring=str(ring.path))
    journal = write_journal(folder, 0, in_journal)
    journal.write_bytes(journal.read_bytes()[:-100])
    return folder


def ended_run(root: Path, rows: int = 500) -> Path:
    """A run whose loop and recorder have ended as they should, not closed yet."""
    folder = new_folder(root)
    write_journal(folder, 0, rows, close=True)
    with EventLog(folder) as events:
        events.write("state", "ready: the procedure came to its end")
    return folder


def errors(folder: Path) -> list[str]:
    """What verify holds against it."""
    return [finding.sentence for finding in verify(folder) if finding.level == "error"]


def test_a_closed_run_has_its_status_its_hashes_its_rows_and_is_read_only(tmp_path: Path) -> None:
    folder = ended_run(tmp_path)
    done = finalise(folder, "completed", "it came to its end", timing={"missed_cycles": 0}, exit=0)
    about = manifest_of(folder)
    assert (done.rows, done.seconds, done.from_ring, done.missing) == (500, 0.499, 0, 0)
    assert (about["status"], about["exit_reason"], about["exit"]) == ("completed", "it came to its end", 0)
    assert (about["rows"], about["duration"]) == (500, 0.499)
    names = {"bench.toml", "events.jsonl", "journal-0001.arrows", "samples.parquet", "timing.json"}
    assert set(about["files"]) == names
    assert about["files"]["samples.parquet"]["rows"] == 500
    assert not {"ring", "process", "closing"} & set(about)
    for name in names:
        assert stat.S_IMODE((folder / name).stat().st_mode) == 0o444
    assert json.loads((folder / "timing.json").read_text()) == {"missed_cycles": 0}
    assert {p.name for p in folder.iterdir()} == {*names, "manifest.json"}
    assert errors(folder) == []
    assert_prefix(folder, 500)


def test_the_status_comes_last(tmp_path: Path) -> None:
    folder, seen = ended_run(tmp_path), []
    finalise(folder, "completed", "end", step=lambda name: seen.append((name, manifest_of(folder)["status"])))
    assert seen == [(name, "running") for name in STEPS]


def test_a_closed_run_is_not_closed_again(tmp_path: Path) -> None:
    folder = ended_run(tmp_path)
    finalise(folder, "stopped", "by the operator")
    with pytest.raises(UsageError, match="is closed already, as stopped: by the operator"):
        finalise(folder, "completed", "end")


def test_a_run_ends_only_as_one_can(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot end as 'running', expected one of completed, stopped"):
        finalise(ended_run(tmp_path), "running", "?")


@pytest.mark.parametrize("step", STEPS)
def test_a_kill_before_any_step_leaves_a_run_that_recover_closes(tmp_path: Path, step: str) -> None:
    folder = ended_run(tmp_path)
    with pytest.raises(Killed):
        finalise(folder, "completed", "the end", step=killer(step))
    assert manifest_of(folder)["status"] == "running"
    assert recover(folder).rows == 500
    assert_prefix(folder, 500)
    assert manifest_of(folder)["status"] == "interrupted"
    assert errors(folder) == []
    if step != "claim":
        assert "the run itself was completed: the end" in manifest_of(folder)["exit_reason"]


@pytest.mark.slow
@pytest.mark.parametrize("second", STEPS)
@pytest.mark.parametrize("first", STEPS)
def test_a_recovery_killed_before_any_step_twice_still_gives_every_row(tmp_path: Path, first: str, second: str) -> None:
    folder = dead_run(tmp_path)
    for step in (first, second):
        with pytest.raises(Killed):
            recover(folder, step=killer(step))
    assert recover(folder).rows == 500
    assert_prefix(folder, 500)
    assert errors(folder) == []
    assert not recover(folder).changed


@pytest.mark.slow
def test_a_real_kill_before_any_step_of_closing_and_of_recovering_loses_nothing(tmp_path: Path) -> None:
    def one(case: tuple[str, str]) -> None:
        act, step = case
        folder = (ended_run if act == "finalise" else dead_run)(tmp_path / act / step)
        killed_at(folder, step, act)
        assert recover(folder).rows == 500
        assert_prefix(folder, 500)
        assert errors(folder) == []

    with ThreadPoolExecutor(4) as pool:
        list(pool.map(one, [(act, step) for act in ("finalise", "recover") for step in STEPS]))


def test_recover_says_what_it_found_and_where(tmp_path: Path) -> None:
    folder = dead_run(tmp_path)
    told = recover(folder)
    assert told.changed
    assert (told.rows, told.seconds) == (500, 0.499)
    assert "500 rows, 0.499 s recovered; 200 of them from shared memory" in told.sentence
    assert "bytes of the journal were half a batch and are left out" in told.sentence
    assert [e["kind"] for e in read_events(folder)] == ["recover"]
    about = manifest_of(folder)
    assert about["status"] == "interrupted"
    assert sorted(p.name for p in folder.glob("journal*")) == ["journal-0001.arrows", "journal-0002.arrows"]
    assert_prefix(folder, 500)


def test_recover_takes_a_trip_that_was_written_down_into_account(tmp_path: Path) -> None:
    folder = dead_run(tmp_path)
    why = "the recorder cannot write: No space left on device; the drive did not confirm that its torque is off"
    with EventLog(folder) as events:
        events.write("trip", f"fault: {why}", 0.4)
    recover(folder)
    about = manifest_of(folder)
    assert about["status"] == "interrupted"  # as the format says of every run found dead
    assert why in about["exit_reason"]
    assert "it had tripped" in about["exit_reason"]
    assert "power" not in about["exit_reason"]
    assert errors(folder) == []


def test_recover_takes_a_run_that_was_over_for_no_kill(tmp_path: Path) -> None:
    folder = dead_run(tmp_path)
    with EventLog(folder) as events:
        events.write("state", "running: kinematic-error run", 0.0)
        events.write("state", "ready: the procedure came to its end", 0.4)
    recover(folder)
    assert "it was over" in manifest_of(folder)["exit_reason"]
    assert "the procedure came to its end" in manifest_of(folder)["exit_reason"]
    assert "power" not in manifest_of(folder)["exit_reason"]


def test_recover_takes_no_trip_of_before_the_run_for_its_end(tmp_path: Path) -> None:
    folder = dead_run(tmp_path)
    with EventLog(folder) as events:
        events.write("trip", "fault: it was too hot")  # waited for a folder, and was reset before the run
    recover(folder)
    assert manifest_of(folder)["status"] == "interrupted"
    assert "found dead and recovered" in manifest_of(folder)["exit_reason"]


def test_recover_says_that_a_run_was_tripped_which_could_not_be_closed(tmp_path: Path) -> None:
    folder = ended_run(tmp_path)
    with pytest.raises(Killed):
        finalise(folder, "tripped", "it is too hot", step=killer("archive"))
    recover(folder)
    assert manifest_of(folder)["exit_reason"].endswith("the run itself was tripped: it is too hot")


def test_recover_without_shared_memory_gives_what_the_journal_has(tmp_path: Path) -> None:
    folder = dead_run(tmp_path)
    Path(manifest_of(folder)["ring"]).unlink()
    assert recover(folder).rows == 300
    assert_prefix(folder, 300)


def test_recover_of_a_run_killed_before_its_journal_gives_what_the_ring_has(tmp_path: Path) -> None:
    folder = dead_run(tmp_path)
    (folder / "journal-0001.arrows").unlink()
    assert recover(folder).rows == 500
    assert_prefix(folder, 500)


def test_recover_of_a_run_killed_before_its_first_row_gives_an_empty_run(tmp_path: Path) -> None:
    told = recover(new_folder(tmp_path))
    assert told.rows == 0
    assert told.changed


def test_rows_the_ring_no_longer_has_are_counted_as_missing(tmp_path: Path) -> None:
    ring = Ring.create(100)
    other = ring_of(500)
    for i, row in enumerate(other.read(0, 500)):
        ring.tell_acked(i)
        ring._rows[i % 100] = row
        ring._counters[0] = i + 1
    folder = new_folder(tmp_path, ring=str(ring.path))
    write_journal(folder, 0, 300)
    told = recover(folder)
    assert told.rows == 399
    assert "101 rows are missing in between" in told.sentence
    assert any("101 rows are missing between two batches" in sentence for sentence in errors(folder))
    for r in (ring, other):
        r.unlink()
        r.close()


def test_a_run_closed_already_is_left_alone_and_said_so(tmp_path: Path) -> None:
    folder = ended_run(tmp_path)
    finalise(folder, "completed", "end")
    before = {p.name: (p.read_bytes(), p.stat().st_mtime_ns) for p in folder.iterdir()}
    told = recover(folder)
    assert not told.changed
    assert "is closed already, as completed, with 500 rows: nothing to recover" in told.sentence
    assert {p.name: (p.read_bytes(), p.stat().st_mtime_ns) for p in folder.iterdir()} == before


def test_a_run_that_is_being_made_is_not_touched(tmp_path: Path) -> None:
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as other:
        pid = other.pid
        folder = new_folder(tmp_path, process={**this_process(), "pid": pid, "started": started(pid)})
        with pytest.raises(NotReady, match=f"is still being made by process {pid}; stop that first"):
            recover(folder)
        other.kill()
    assert recover(folder).rows == 0


def test_a_run_whose_recorder_still_writes_is_not_touched(tmp_path: Path) -> None:
    ring = ring_of(10)
    me = this_process()
    ring.tell_reader(me["pid"], me["started"])
    folder = new_folder(tmp_path, ring=str(ring.path), process={**me, "pid": 0})
    with pytest.raises(NotReady, match=f"process {me['pid']}, is still writing"):
        recover(folder)
    ring.unlink()
    ring.close()


def test_two_recoveries_at_once_do_not_mix(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rig.runfile.finalise.PATIENCE", 0.0)
    folder = new_folder(tmp_path)
    with sole_writer(folder), pytest.raises(NotReady, match="being written by another process"):
        recover(folder)


def test_a_recovered_run_is_the_same_to_the_byte_as_one_closed_properly(tmp_path: Path) -> None:
    folder = dead_run(tmp_path)
    other = ended_run(tmp_path / "other")
    recover(folder)
    finalise(other, "completed", "end")
    assert (folder / "samples.parquet").read_bytes() == (other / "samples.parquet").read_bytes()


def test_a_disk_that_is_full_when_closing_is_a_sentence_and_a_second_try_succeeds(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = ended_run(tmp_path)

    def full(handle: int) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(DataError, match="cannot be closed: No space left on device"):
            finalise(folder, "completed", "end")
    finalise(folder, "completed", "end")
    assert manifest_of(folder)["status"] == "completed"
    assert errors(folder) == []


def test_a_result_is_entered_with_its_hash_as_often_as_it_is_made_anew(tmp_path: Path) -> None:
    folder = ended_run(tmp_path)
    finalise(folder, "completed", "end")
    for verdict in ("FAIL", "PASS"):
        (folder / "result.json").write_text(f'{{"verdict": "{verdict}"}}')
        (folder / "report.html").write_text(f"<p>{verdict}")
        add_derived(folder, "result.json", "report.html", verdict=verdict)
    assert manifest_of(folder)["verdict"] == "PASS"
    assert errors(folder) == []
    (folder / "result.json").write_text("{}")
    assert errors(folder) == ["result.json is not what it was: its SHA-256 differs from the manifest's"]


def test_raw_data_is_never_entered_anew(tmp_path: Path) -> None:
    folder = ended_run(tmp_path)
    finalise(folder, "completed", "end")
    with pytest.raises(UsageError, match=r"samples\.parquet of .* is raw data"):
        add_derived(folder, "samples.parquet")


def test_a_copy_of_a_dead_run_can_be_recovered_elsewhere(tmp_path: Path) -> None:
    folder = copy_of(dead_run(tmp_path), tmp_path / "copy")
    manifest.update(folder, process={"pid": 1, "started": 1, "host": "the rig's own computer"})
    assert recover(folder).rows == 500


LEAST = {"schema": "hdrig.run/1", "procedure": "other", "gear": {"ratio": 50}}


def whole(folder: Path) -> dict[str, tuple[bytes, int]]:
    """Every file, and when it was changed."""
    return {p.name: (p.read_bytes(), p.stat().st_mtime_ns) for p in folder.iterdir()}


@pytest.mark.parametrize(
    "about", [{}, {"backend": "imported", "status": "completed"}, {"status": "completed"}, {"status": "running"}]
)
def test_samples_without_a_journal_are_never_replaced(tmp_path: Path, about: dict[str, str]) -> None:
    (tmp_path / "manifest.json").write_text(json.dumps(LEAST | about))
    pq.write_table(pa.table({"theta_m": [1.0, 2.0, 3.0]}), tmp_path / "samples.parquet")
    before = whole(tmp_path)
    told = recover(tmp_path)
    assert not told.changed
    assert "nothing to recover" in told.sentence
    with pytest.raises(DataError, match="holds 3 rows, the journal 0: it is not overwritten"):
        finalise(tmp_path, "completed", "end")
    assert whole(tmp_path) == before


@pytest.mark.parametrize("about", [{}, {"status": "completed"}, {"status": "running"}])
@pytest.mark.parametrize("end", [10, -200])
def test_samples_that_cannot_be_read_and_no_journal_are_said_to_be_so(
    tmp_path: Path, about: dict[str, str], end: int
) -> None:
    (tmp_path / "manifest.json").write_text(json.dumps(LEAST | about))
    samples = tmp_path / "samples.parquet"
    pq.write_table(pa.table({"theta_m": [0.1 * k for k in range(1000)]}), samples)
    samples.write_bytes(samples.read_bytes()[:end])
    before = whole(tmp_path)
    with pytest.raises(DataError, match=r"samples.parquet cannot be read: .*; there is no journal and no ring"):
        recover(tmp_path)
    assert whole(tmp_path) == before


def test_a_journal_with_fewer_rows_does_not_replace_the_samples(tmp_path: Path) -> None:
    folder = ended_run(tmp_path)
    with pytest.raises(Killed):
        finalise(folder, "completed", "end", step=killer("timing"))
    (folder / "journal-0001.arrows").unlink()
    write_journal(folder, 0, 499)
    before = whole(folder)["samples.parquet"]
    with pytest.raises(DataError, match="holds 500 rows, the journal 499"):
        recover(folder)
    assert whole(folder)["samples.parquet"] == before


@pytest.mark.parametrize(
    ("about", "sentence"),
    [({"gear": {}}, "gear.ratio is missing"), ({}, "has no samples: neither samples.parquet nor a journal")],
)
def test_a_folder_with_nothing_to_recover_is_left_as_it_is(
    tmp_path: Path, about: dict[str, object], sentence: str
) -> None:
    (tmp_path / "manifest.json").write_text(json.dumps(LEAST | about))
    with pytest.raises(UsageError, match=sentence):
        recover(tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == ["manifest.json"]


def test_rows_the_loop_made_and_nobody_has_make_the_run_interrupted(tmp_path: Path) -> None:
    folder = ended_run(tmp_path)
    assert finalise(folder, "completed", "end", expected_rows=520).lost == 20
    about = manifest_of(folder)
    assert (about["status"], about["rows_expected"]) == ("interrupted", 520)
    assert "of the 520 rows the loop made 500 are here and 20 are lost" in about["exit_reason"]
    assert errors(folder) == ["20 of 520 rows the loop made are missing"]


def test_every_row_the_loop_made_leaves_the_run_as_it_ended(tmp_path: Path) -> None:
    folder = ended_run(tmp_path)
    assert finalise(folder, "completed", "end", expected_rows=500).lost == 0
    assert manifest_of(folder)["status"] == "completed"
    assert errors(folder) == []


def test_lost_rows_are_told_by_whoever_closes_the_run_in_the_end(tmp_path: Path) -> None:
    folder = ended_run(tmp_path)
    with pytest.raises(Killed):
        finalise(folder, "completed", "end", expected_rows=520, step=killer("drain"))
    assert "20 of the 520 rows the loop made are lost" in recover(folder).sentence
    assert errors(folder) == ["20 of 520 rows the loop made are missing"]


@pytest.mark.parametrize(("ticks", "said"), [(501, []), (503, ["3 of 503 rows the loop made are missing"])])
def test_rows_are_compared_with_the_ticks_of_the_loop(tmp_path: Path, ticks: int, said: list[str]) -> None:
    folder = ended_run(tmp_path)
    finalise(folder, "completed", "end", timing={"ticks": ticks})
    assert errors(folder) == said
