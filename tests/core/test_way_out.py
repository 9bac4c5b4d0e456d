"""How a verb ends: what the person is told, and the exit code."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from rig.core.errors import Exit
from rig.core.way_out import ending_in_a_sentence


def test_a_place_nobody_may_look_into_is_a_sentence_and_no_internal_error(capsys: pytest.CaptureFixture[str]) -> None:
    def act() -> int:
        raise PermissionError(errno.EACCES, "Permission denied", "/shut/manifest.json")

    assert ending_in_a_sentence(act) == Exit.USAGE
    assert capsys.readouterr().err == "hdrig: /shut/manifest.json cannot be used: Permission denied\n"


def test_a_permission_of_no_place_stays_an_internal_error(capsys: pytest.CaptureFixture[str]) -> None:
    def act() -> int:
        raise PermissionError(errno.EPERM, "Operation not permitted")

    assert ending_in_a_sentence(act) == Exit.INTERNAL
    assert "internal error" in capsys.readouterr().err


def test_a_current_folder_that_is_gone_is_a_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    here.rmdir()
    assert ending_in_a_sentence(lambda: len(os.path.abspath("runs"))) == Exit.USAGE
    assert capsys.readouterr().err == "hdrig: the current folder no longer exists; change to one that does\n"


def test_a_file_that_is_gone_stays_an_internal_error(capsys: pytest.CaptureFixture[str]) -> None:
    assert ending_in_a_sentence(lambda: os.stat("/nowhere/at/all").st_size) == Exit.INTERNAL
    assert "internal error" in capsys.readouterr().err
