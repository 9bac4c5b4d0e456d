"""Ctrl-C, kill, faults: whatever ends a run, the torque is off first and the samples are kept."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

from rig.cli import main
from rig.runfile.recover import recover
from rig.runfile.verify import verify

# a shared machine stalls for tens of ms: the drive of these tests is patient, what is tested is the order of events
STILL = ["standstill", "--with", "duration=1000"]  # nothing to prove first: 10 s less to wait for
SHOWN = "[!.]*"  # hdrig tries a folder by one that is hidden and gone again, maybe while it is listed here
WALL = ["--clock", "wall", "--set", "twin.watchdog=1.0"]


def start(root: Path, *procedure: str) -> subprocess.Popen[str]:
    args = [sys.executable, "-m", "rig.cli", "run", *(procedure or ["kinematic-error"]), *WALL, "--out", str(root)]
    return subprocess.Popen(args, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def wait_for(root: Path, what: str, process: subprocess.Popen[str], rows_bytes: int = 60_000) -> Path:
    """The folder of the run called `what`, once its journal holds samples."""
    for _ in range(4000):  # 80 s: the proof takes 10; a run that never comes must not hang the suite
        if process.poll() is not None:
            break
        for folder in root.glob(f"{SHOWN}/*{what}*"):
            journal = folder / "journal-0001.arrows"
            if journal.exists() and journal.stat().st_size > rows_bytes:
                return folder
        time.sleep(0.02)
    process.kill()
    raise AssertionError(f"no {what} came: {process.communicate()}")


def last_row(folder: Path) -> dict[str, float]:
    table = pq.read_table(folder / "samples.parquet")
    row: dict[str, float] = table.slice(table.num_rows - 1).to_pylist()[0]
    return row


def events(folder: Path) -> list[dict[str, str]]:
    return [json.loads(line) for line in (folder / "events.jsonl").read_text().splitlines()]


@pytest.mark.slow
@pytest.mark.parametrize("sig", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.long)])
def test_one_signal_stops_the_motor_and_finishes_the_run(sig: signal.Signals, tmp_path: Path) -> None:
    process = start(tmp_path)
    folder = wait_for(tmp_path, "kinematic-error", process)
    process.send_signal(sig)
    _, err = process.communicate(timeout=120)
    assert process.returncode == 4, err
    manifest = json.loads((folder / "manifest.json").read_text())
    assert (manifest["status"], manifest["exit"]) == ("stopped", 4)
    assert last_row(folder)["tau_applied"] == 0.0
    assert abs(last_row(folder)["omega_m"]) < 0.2
    kinds = [e["kind"] for e in events(folder)]
    assert "operator" in kinds
    assert [f for f in verify(folder) if f.level == "error"] == []
    assert "Traceback" not in err
    assert (folder / "report.html").exists()


@pytest.mark.slow
@pytest.mark.parametrize(
    "signals",
    [
        (signal.SIGINT, signal.SIGTERM),  # another signal: two of one kind may merge into one
        pytest.param((signal.SIGQUIT,), marks=pytest.mark.long),
    ],
)
def test_two_signals_or_ctrl_backslash_take_the_torque_off_at_once_and_keep_the_run(
    signals: tuple[signal.Signals, ...], tmp_path: Path
) -> None:
    process = start(tmp_path)
    folder = wait_for(tmp_path, "kinematic-error", process)
    for number in signals:
        process.send_signal(number)
    _, err = process.communicate(timeout=120)
    assert process.returncode == 130, err
    assert json.loads((folder / "manifest.json").read_text())["status"] == "stopped"
    assert last_row(folder)["tau_applied"] == 0.0
    assert "Traceback" not in err


@pytest.mark.slow
def test_a_signal_during_the_proof_ends_everything_with_the_operators_exit_code(tmp_path: Path) -> None:
    process = start(tmp_path)
    folder = wait_for(tmp_path, "sign-and-scale", process, rows_bytes=20_000)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=120)
    assert process.returncode == 4, err
    assert not list(tmp_path.glob("*/*kinematic-error*"))
    assert json.loads((folder / "manifest.json").read_text())["status"] == "stopped"


@pytest.mark.slow
def test_kill_9_loses_nothing_and_recover_says_interrupted(tmp_path: Path) -> None:
    process = start(tmp_path, *STILL)
    folder = wait_for(tmp_path, "standstill", process, rows_bytes=200_000)
    process.kill()
    killed = time.monotonic()
    process.communicate()
    while time.monotonic() - killed < 20:  # the recorder outlives the loop and closes the journal
        if json.loads((folder / "manifest.json").read_text())["status"] == "interrupted":
            break
        time.sleep(0.05)
    found = recover(folder)
    manifest = json.loads((folder / "manifest.json").read_text())
    assert manifest["status"] == "interrupted"
    assert found.rows > 1000
    t = pq.read_table(folder / "samples.parquet")["t"].to_numpy()
    assert np.all(np.diff(t) > 0)
    assert [f for f in verify(folder) if f.level == "error"] == []


@pytest.mark.slow
@pytest.mark.parametrize("procedure", [STILL, pytest.param(["kinematic-error"], marks=pytest.mark.long)])
def test_killing_the_recorder_trips_the_run_and_its_rows_are_kept(procedure: list[str], tmp_path: Path) -> None:
    process = start(tmp_path, *procedure)
    folder = wait_for(tmp_path, procedure[0], process)
    os.kill(recorder_of(process.pid), signal.SIGKILL)
    _, err = process.communicate(timeout=120)
    assert process.returncode == 5, err
    assert "recorder died" in err
    assert f"what was recorded is in {folder}; hdrig analyse {folder} makes its report" in " ".join(err.split())
    manifest = json.loads((folder / "manifest.json").read_text())
    assert manifest["status"] == "tripped"
    assert [f for f in verify(folder) if f.level == "error"] == []
    assert "Traceback" not in err


def recorder_of(pid: int) -> int:
    """The child process that records."""
    for entry in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):  # a process that ended meanwhile is not it
            fields = entry.read_text().rsplit(")", 1)[1].split()
            if int(fields[1]) == pid and b"rig.recorder" in (entry.parent / "cmdline").read_bytes():
                return int(entry.parent.name)
    raise AssertionError(f"process {pid} has no recorder")


@pytest.mark.slow
def test_a_journal_that_cannot_grow_trips_the_run_and_every_row_is_kept(tmp_path: Path) -> None:
    # 8 MB is room for the ring (6.8 MB) and for 80 s of journal; the run would need 10 MB
    limit = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (8_000_000, resource.RLIM_INFINITY)); "
    code = limit + "import rig.cli; raise SystemExit(rig.cli.main())"
    args = ["run", "kinematic-error", "--out", str(tmp_path), "--with", "cycles=1", "--with", "frequency=0.01"]
    done = subprocess.run([sys.executable, "-c", code, *args], capture_output=True, text=True, timeout=300)
    assert done.returncode == 5, done.stderr
    assert "File too large" in done.stderr
    assert "Traceback" not in done.stderr
    (folder,) = tmp_path.glob("*/*kinematic-error*")
    manifest = json.loads((folder / "manifest.json").read_text())
    assert (manifest["status"], manifest["exit"]) == ("tripped", 5)
    assert manifest["rows"] > 75_000  # what the journal held at 8 MB, and all that waited in the ring
    t = pq.read_table(folder / "samples.parquet")["t"].to_numpy()
    assert np.allclose(np.diff(t), 1e-3, atol=1e-6)
    assert [f for f in verify(folder) if f.level == "error"] == []


def test_a_place_that_cannot_be_written_is_refused_before_anything_moves(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("in the way")
    assert main(["run", "kinematic-error", "--out", str(tmp_path / "file" / "runs")]) == 2
    assert "Not a directory" in capsys.readouterr().err
