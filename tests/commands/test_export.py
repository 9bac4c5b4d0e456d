"""hdrig export: where files of several runs go, and what is not exported; nor is it viewed."""

from __future__ import annotations

from pathlib import Path

import pyarrow.parquet as pq
import pytest

from rig.cli import main
from tests.commands.made_run import made_run


def test_several_runs_do_not_go_into_one_file_and_nothing_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    runs = [str(made_run(tmp_path / name)) for name in ("one", "two")]
    one = tmp_path / "x.csv"
    assert main(["export", *runs, "--as", "csv", "--out", str(one)]) == 2
    assert f"--out {one} is one file, and these are 2 runs: expected a folder" in capsys.readouterr().err
    assert not one.exists()
    assert main(["export", *runs, "--as", "csv", "--out", str(tmp_path / "both")]) == 0


@pytest.mark.slow
@pytest.mark.parametrize("command", ["export", "view"])
def test_it_is_said_of_the_twins_samples_that_they_are_simulated_and_stdout_is_the_path(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for backend, said in (("sim", f"SIMULATED: {tmp_path / 'sim'} was recorded on the twin\n"), ("can", "")):
        run = made_run(tmp_path / backend, {"backend": backend})
        assert main([command, str(run)]) == 0
        told = capsys.readouterr()
        assert told.err == said
        (made,) = told.out.splitlines()
        assert Path(made).is_file()


@pytest.mark.parametrize("command", ["export", "view"])
def test_samples_that_are_not_those_the_run_was_closed_with_go_nowhere(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run = made_run(tmp_path / "one")
    samples = pq.read_table(run / "samples.parquet")
    pq.write_table(samples.drop_columns(["theta_l"]), run / "samples.parquet")
    before = {path.name for path in run.iterdir()}
    assert main([command, str(run)]) == 6
    assert "samples.parquet is not the file this run was closed with (its SHA-256 differs)" in capsys.readouterr().err
    assert {path.name for path in run.iterdir()} == before
