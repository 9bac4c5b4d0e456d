"""How a verb ends: what the person is told, and the exit code."""

from __future__ import annotations

import errno

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
