"""What `hdrig serve` cannot do is a sentence and exit code 3, said before anything is started."""

from __future__ import annotations

from pathlib import Path

import pytest

from rig.cli import main


@pytest.mark.parametrize("port", ["65536", "99999", "-1"])
def test_a_port_there_is_not_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str], port: str) -> None:
    assert main(["serve", f"--port={port}", "--out", str(tmp_path)]) == 3
    assert "ports go from 0, which finds a free one, to 65535" in capsys.readouterr().err


def test_a_folder_that_cannot_be_made_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert main(["serve", "--port=0", "--out", str(tmp_path / "file/runs")]) == 3
    assert "cannot be made: Not a directory" in capsys.readouterr().err
