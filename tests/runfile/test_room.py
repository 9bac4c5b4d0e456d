"""A disk without room for a run is found before the motor turns, and said with both numbers."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import NamedTuple

import pytest

from rig.cli import main
from rig.core.errors import Exit, UsageError
from rig.runfile.room import BESIDE, MARGIN, refuse_no_room, rows_bytes


class Usage(NamedTuple):
    """As shutil tells it."""

    total: int
    used: int
    free: int


def left(monkeypatch: pytest.MonkeyPatch, free: float) -> None:
    monkeypatch.setattr(shutil, "disk_usage", lambda path: Usage(int(1e9), 0, int(free)))


def test_a_run_that_does_not_fit_is_refused_before_the_proof(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    left(monkeypatch, 3e6)
    assert main(["run", "kinematic-error", "--out", str(tmp_path)]) == Exit.USAGE
    said = capsys.readouterr().err
    assert "has 3.0 MB free, kinematic-error needs up to " in said
    assert "name another place with --out" in said
    assert "about to turn" not in said
    assert list(tmp_path.iterdir()) == []


def test_what_just_fits_is_let_through(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    needed = MARGIN * rows_bytes(1e5) + BESIDE
    left(monkeypatch, needed + 1)
    refuse_no_room(tmp_path / "not" / "there", 1e5, "a run")
    left(monkeypatch, needed - 1)
    with pytest.raises(UsageError, match=r"a run needs up to .* MB \(100000 rows"):
        refuse_no_room(tmp_path, 1e5, "a run")
