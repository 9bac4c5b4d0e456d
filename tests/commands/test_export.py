"""hdrig export: where files of several runs go."""

from __future__ import annotations

from pathlib import Path

import pytest

from rig.cli import main
from tests.commands.made_run import made_run


def test_several_runs_do_not_go_into_one_file_and_nothing_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    runs = [str(made_run(tmp_path / name)) for name in ("one", "two")]
    one = tmp_path / "x.csv"
    assert main(["export", *runs, "--as", "csv", "--to", str(one)]) == 2
    assert f"--to {one} is one file, and these are 2 runs: expected a folder" in capsys.readouterr().err
    assert not one.exists()
    assert main(["export", *runs, "--as", "csv", "--to", str(tmp_path / "both")]) == 0
