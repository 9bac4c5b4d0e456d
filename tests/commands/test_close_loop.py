"""What close-loop says at its end: a path to copy, and one round is one round."""

from __future__ import annotations

import shlex
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from rig.closing.story import End, Story, write_story
from rig.commands import close_loop
from rig.core.errors import Exit
from rig.evaluation.trace import trace_folder
from rig.report.trace import page as trace_page
from tests.report.trace import made_up


def test_the_folder_to_go_on_with_can_be_copied_whatever_its_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "Prüfstand 1"
    folder.mkdir()
    story = Story("c", True, 60.0, End.STOPPED, "Stopped by the operator.")
    write_story(folder, story)
    bench: Any = SimpleNamespace(simulated=True)
    close_loop._tell(folder, story, bench, Exit.STOPPED)
    said = capsys.readouterr()
    assert "after 0 rounds: Stopped" in said.out
    assert shlex.split(said.err)[:4] == ["hdrig", "close-loop", "--resume", str(folder)]


def test_every_round_leaves_the_trace_and_its_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = made_up.nothing()
    monkeypatch.setattr("rig.analysis.tracing.trace.trace", lambda folder: made)
    monkeypatch.setattr(trace_page, "render", lambda trace, origin: "page")
    assert trace_folder(tmp_path) is made
    assert {path.name for path in tmp_path.iterdir()} == {"trace.json", "report.html"}
