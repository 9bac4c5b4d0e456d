"""A campaign that is not over says so before any verdict, and one that is being made is not traced."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest

from rig.analysis.tracing.runs.unfinished import refuse_going_on, unfinished
from rig.core.errors import NotReady
from rig.runfile.process import this_process


def book(folder: Path, **changes: Any) -> Path:
    runs = [{"status": status} for status in ("done", "stopped", "planned")]
    (folder / "campaign.json").write_text(json.dumps({"status": "stopped", "process": None, "runs": runs} | changes))
    return folder


def test_how_much_of_the_plan_is_there_is_told(tmp_path: Path) -> None:
    assert "not over: 1 of its 3 planned runs is done" in unfinished(book(tmp_path))
    assert unfinished(book(tmp_path, status="completed")) == ""
    assert unfinished(book(tmp_path, status="running", runs=[{"status": "done"}])) == ""  # killed when all was made


def test_a_run_that_is_gone_is_told_of_and_one_that_was_renamed_is_not(tmp_path: Path) -> None:
    runs = [{"status": "done", "run": f"0820-sentinel-X-{uid}"} for uid in ("aaaa", "bbbb", "cccc")]
    book(tmp_path, status="completed", uid="c", runs=runs)
    for name, uid, number in (("0820-sentinel-X-aaaa", "aaaa1", 1), ("renamed", "bbbb2", 2), ("another", "cccc3", 1)):
        (tmp_path / name).mkdir()
        about = {"schema": "hdrig.run/1", "uid": uid, "campaign": {"uid": "c", "run": number}}
        (tmp_path / name / "manifest.json").write_text(json.dumps(about))
    assert unfinished(tmp_path) == (
        "Of the runs that campaign.json calls done 1 is not there: 0820-sentinel-X-cccc. What the others would show is "
        "not known; hdrig campaign --resume takes it up."
    )


@pytest.mark.parametrize("text", [None, "", "[]", "{}", '{"runs": 3}', '{"runs": [1, {}]}', "\x00"])
def test_what_nobody_planned_is_not_told_to_be_unfinished(text: str | None, tmp_path: Path) -> None:
    if text is not None:
        (tmp_path / "campaign.json").write_text(text)
    refuse_going_on(tmp_path)
    assert "of its 0" not in unfinished(tmp_path)


def test_a_campaign_that_another_process_makes_is_left_to_it(tmp_path: Path) -> None:
    refuse_going_on(book(tmp_path, status="running", process=this_process()))  # close-loop traces what it made
    maker = {**this_process(), "pid": os.getppid()}
    maker["started"] = int(Path(f"/proc/{os.getppid()}/stat").read_text().rpartition(")")[2].split()[19])
    with pytest.raises(NotReady, match=rf"being made by process {os.getppid()}: 1 of its 3 planned runs is done"):
        refuse_going_on(book(tmp_path, status="running", process=maker))
