"""What `hdrig serve` cannot do is a sentence, said before anything is started."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest

from rig.cli import main


@pytest.mark.parametrize("port", ["65536", "99999", "-1"])
def test_a_port_there_is_not_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str], port: str) -> None:
    assert main(["serve", f"--port={port}", "--out", str(tmp_path)]) == 2
    assert "ports go from 0, which finds a free one, to 65535" in capsys.readouterr().err


def test_a_folder_that_cannot_be_made_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert main(["serve", "--port=0", "--out", str(tmp_path / "file/runs")]) == 2
    assert "file/runs: Not a directory; name another place with --out" in capsys.readouterr().err


def test_a_folder_that_takes_no_run_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["serve", "--port=0", "--out", "/proc"]) == 2  # it is there, and takes no file, of nobody
    assert "cannot write /proc: " in capsys.readouterr().err


def test_another_port_is_advised_where_the_port_is_taken_and_not_where_the_address_is_not_ours(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        assert main(["serve", f"--port={taken.getsockname()[1]}", "--out", str(tmp_path)]) == 3
    assert "Address already in use; --port 0 finds a free one" in capsys.readouterr().err
    assert main(["serve", "--host=192.0.2.1", "--out", str(tmp_path)]) == 3  # of RFC 5737: nobody has it
    assert "nothing can listen at 192.0.2.1, port 8765: Cannot assign requested address\n" in capsys.readouterr().err
