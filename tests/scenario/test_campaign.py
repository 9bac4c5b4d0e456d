"""A campaign through the command line: the plan that ships, a stop, and kill -9 wherever it comes."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rig.catalogue import runs as list_runs
from rig.cli import main
from rig.runfile.verify import verify

PLAN = """
schema = "hdrig.plan/1"
name = "kill"
[[step]]
procedure = "standstill"
with = { duration = 1 }
[[step]]
procedure = "kinematic-error"
with = { amplitude_deg = 720, frequency = 0.02, cycles = 1 }
[[step]]
procedure = "standstill"
with = { duration = 1 }
weight = 3.0
"""
Book = dict[str, Any]


def start(root: Path, *args: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "rig.cli", "campaign", *args, "--out", str(root)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def book_of(root: Path) -> Book:
    return json.loads(next(root.glob("*/campaign.json")).read_text())  # type: ignore[no-any-return]


def wait_until(root: Path, process: subprocess.Popen[str], seen: Callable[[Book], bool]) -> None:
    """Until campaign.json shows it: 120 s at most, or the end of the process."""
    for _ in range(24_000):
        if any(root.glob("*/campaign.json")) and seen(book_of(root)):
            return
        if process.poll() is not None:
            break
        time.sleep(0.005)
    process.kill()
    raise AssertionError(f"it never came to that: {process.communicate()}")


def second_run(book: Book) -> bool:
    return bool(book["runs"][1]["status"] == "running")


def hanging(book: Book) -> bool:
    return book["pending"] is not None


def errors(folder: Path) -> list[Any]:
    return [finding for run in list_runs(folder) for finding in verify(run.path) if finding.level == "error"]


@pytest.mark.long
@pytest.mark.parametrize(("point", "made"), [(second_run, 1), (hanging, 2)])
def test_kill_9_at_any_moment_leaves_a_campaign_that_goes_on(
    point: Callable[[Book], bool], made: int, tmp_path: Path
) -> None:
    (tmp_path / "kill.toml").write_text(PLAN)
    root = tmp_path / "runs"
    process = start(root, str(tmp_path / "kill.toml"))
    wait_until(root, process, point)
    time.sleep(0.3)  # into whatever it began
    process.kill()
    process.communicate()
    before = book_of(root)
    assert [entry["status"] for entry in before["runs"]].count("done") >= made
    folder = next(root.glob("*/campaign.json")).parent
    again = start(root, "--resume", str(folder))
    _, err = again.communicate(timeout=200)
    assert again.returncode == 0, err
    after = book_of(root)
    assert [entry["status"] for entry in after["runs"]] == ["done"] * 3
    for earlier, later in zip(before["runs"], after["runs"], strict=True):
        if earlier["status"] == "done":
            assert later["run"] == earlier["run"]  # not made again
        if earlier["status"] == "running":
            assert [attempt["status"] for attempt in later["attempts"]] == ["interrupted", "done"]
            if begun := later["attempts"][0]["run"]:  # else it was killed before the run had a folder
                assert json.loads((folder / begun / "manifest.json").read_text())["status"] == "interrupted"
    assert {run.status for run in list_runs(folder)} <= {"completed", "interrupted"}
    assert errors(folder) == []
    assert "Traceback" not in err


@pytest.mark.slow
def test_ctrl_c_once_stops_the_run_properly_and_the_campaign_is_resumable(tmp_path: Path) -> None:
    (tmp_path / "kill.toml").write_text(PLAN)
    root = tmp_path / "runs"
    process = start(root, str(tmp_path / "kill.toml"))
    wait_until(root, process, second_run)
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=120)
    assert process.returncode == 4, err
    book = book_of(root)
    assert (book["status"], book["runs"][1]["status"]) == ("stopped", "stopped")
    assert "campaign kill stopped" in out
    assert "goes on with it" in err
    assert errors(root) == []


@pytest.mark.long
def test_the_quick_plan_runs_to_its_end_and_says_what_it_measured(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["campaign", "quick", "--out", str(tmp_path), "--seed", "2"]) == 0
    out = capsys.readouterr().out
    book = book_of(tmp_path)
    assert (book["status"], book["seed"]) == ("completed", 2)
    assert {entry["status"] for entry in book["runs"]} == {"done"}
    folder = next(tmp_path.glob("*/campaign.json")).parent
    assert (folder / "summary.txt").read_text() in out
    assert "SIMULATED campaign quick completed" in out
    torque = r"^sentinels: Mean motor torque .* N·m first, .* N·m last, change .* ± .* over 2 sentinels \(.*95 %.*\)\.$"
    assert len(re.findall(torque, out, re.M)) == 1
    assert len(re.findall(r"^sentinels: each found its own torque, so speed .* not compared", out, re.M)) == 1
    assert " rpm first" not in out  # 3 mN·m are 14 rpm: what followed from them was no change of the gear
    for entry in book["runs"]:
        assert {"report.html", "result.json", "samples.parquet"} <= {p.name for p in (folder / entry["run"]).iterdir()}
    assert errors(folder) == []


def test_a_campaign_of_nothing_to_resume_is_a_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["campaign", "--resume", str(tmp_path)]) == 2
    assert "is not a campaign folder" in capsys.readouterr().err
    assert main(["campaign"]) == 2
    assert "name a plan" in capsys.readouterr().err
    assert main(["campaign", "quick", "--skip", "3"]) == 2
    assert "--skip goes with --resume" in capsys.readouterr().err
