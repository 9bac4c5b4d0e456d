"""Runs that are not what they say, and folders nobody may read, are left out by name; none goes without a word."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from rig.analysis.tracing.runs import campaign as module
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.core.errors import UsageError
from tests.analysis.tracing.test_few_channels import reduced

RUNS = ("speed_120rpm_1", "speed_120rpm_2", "lock_20_1")


def test_a_locked_output_that_turns_is_no_lock_test(tmp_path: Path, shared: Path) -> None:
    reduced(tmp_path, shared / "cases" / "open-1", RUNS, ())
    said = json.loads((tmp_path / RUNS[1] / "manifest.json").read_text())
    said["conditions"]["output_locked"] = True
    (tmp_path / RUNS[1] / "manifest.json").write_text(json.dumps(said))
    campaign = read_campaign(tmp_path)
    assert [run.name for run in campaign.runs if run.name in RUNS] == [RUNS[0], RUNS[2]]
    assert any(f"{RUNS[1]} was left out: it says its output is locked" in note for note in campaign.notes)


def test_a_folder_nobody_may_look_into_is_named(tmp_path: Path, shared: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    reduced(tmp_path, shared / "cases" / "open-1", RUNS[:1], ())
    (tmp_path / "closed").mkdir()
    access = os.access
    monkeypatch.setattr(module.os, "access", lambda path, mode: path.name != "closed" and access(path, mode))
    campaign = read_campaign(tmp_path)
    assert campaign.left_out == ("closed",)
    assert "closed was left out: it cannot be read: permission denied." in campaign.notes


def test_a_campaign_nobody_may_look_into_is_no_empty_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module.os, "access", lambda path, mode: False)
    with pytest.raises(UsageError, match="cannot be read: permission denied"):
        read_campaign(tmp_path)
