"""What a run ends with whose report is interrupted."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from rig.cli import main
from rig.commands import perform
from rig.core.errors import Exit
from rig.loop import Ending
from rig.session.done import Done
from tests.commands.made_run import made_run


@pytest.mark.parametrize(
    ("status", "code", "exit", "kept"),
    [
        ("stopped", Exit.STOPPED, 4, "is kept, stopped,"),
        ("tripped", Exit.TRIPPED, 5, "is kept, tripped,"),
        ("completed", Exit.PASS, Exit.HALTED, "is complete"),
    ],
)
def test_ctrl_c_in_the_report_ends_a_run_as_it_had_ended(
    status: str,
    code: Exit,
    exit: int,
    kept: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    folder = made_run(tmp_path / "run")

    def pressed(*_: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(perform, "_recorded", lambda *_: (Done(folder, Ending(status, "as it was", code)), False))
    monkeypatch.setattr(perform, "analyse_folder", pressed)
    assert main(["run", "standstill", "--out", str(tmp_path / "out")]) == exit
    assert f"the run {kept} in {folder}; hdrig analyse makes its report" in capsys.readouterr().err


def test_ctrl_c_when_nothing_was_left_of_the_run_to_end_makes_no_report(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It came after the last tick, and before anybody listened to it again."""
    folder = made_run(tmp_path / "run")
    ended = Done(folder, Ending("completed", "as it was", Exit.PASS)), True
    monkeypatch.setattr(perform, "_recorded", lambda *_: ended)
    monkeypatch.setattr(perform, "analyse_folder", lambda *_: pytest.fail("a report was made"))
    assert main(["run", "standstill", "--out", str(tmp_path / "out")]) == Exit.HALTED
    assert f"the run is complete in {folder}; hdrig analyse makes its report" in capsys.readouterr().err
