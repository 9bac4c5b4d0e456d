"""Runs named on the command line: what a shell adds to them is left out in a sentence, what is missing is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from rig.cli import main
from rig.commands.folders import expand, for_each
from rig.core.errors import Exit, UsageError


@pytest.fixture
def campaign(tmp_path: Path) -> Path:
    """Two runs, a folder with a third one, and what a trace leaves."""
    for name in ("run-1", "run-2", "checks/proof"):
        (tmp_path / name).mkdir(parents=True)
        (tmp_path / name / "manifest.json").write_text("{}")
    for name in ("report.html", "trace.json"):
        (tmp_path / name).write_text("")
    return tmp_path


def test_files_among_the_runs_of_a_campaign_are_left_out_and_named(
    campaign: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = expand(sorted(campaign.iterdir()))
    assert [path.name for path in found] == ["proof", "run-1", "run-2"]
    assert capsys.readouterr().err == "left out, for they are files and no runs: report.html, trace.json\n"


def test_a_file_alone_or_files_alone_are_refused(campaign: Path) -> None:
    with pytest.raises(UsageError, match=r"report\.html is neither a run folder nor holds any"):
        expand([campaign / "report.html"])
    with pytest.raises(UsageError, match=r"report\.html, trace\.json: expected run folders, these are files"):
        expand([campaign / "report.html", campaign / "trace.json"])


def test_what_does_not_exist_or_is_empty_is_refused_among_others_too(campaign: Path) -> None:
    (campaign / "empty").mkdir()
    with pytest.raises(UsageError, match="run-3 does not exist"):
        expand([campaign / "run-1", campaign / "run-3"])
    with pytest.raises(UsageError, match="empty is neither"):
        expand([campaign / "run-1", campaign / "empty"])


def test_runs_alone_say_nothing(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert len(expand([campaign])) == 3
    assert capsys.readouterr().err == ""


def test_samples_without_a_manifest_are_a_run_that_every_verb_has_a_word_for(
    campaign: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (campaign / "run-2" / "manifest.json").unlink()
    (campaign / "run-2" / "journal-0001.arrows").write_bytes(b"")
    assert [path.name for path in expand([campaign])] == ["proof", "run-1", "run-2"]
    assert expand([campaign / "run-2"]) == [campaign / "run-2"]
    assert main(["verify", str(campaign / "run-2")]) == Exit.INCOMPLETE
    said = "it has samples and no manifest.json; hdrig recover makes it anew where bench.toml and samples lie beside it"
    assert capsys.readouterr().out == f"run-2: BROKEN\n  error   {said}\n"
    assert main(["export", str(campaign / "run-2")]) == Exit.USAGE
    assert capsys.readouterr().err == f"hdrig: {campaign / 'run-2'}: {said}\n"
    assert main(["list", str(campaign)]) == Exit.PASS
    assert "run-2 has samples and no manifest.json" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("said", "shown"),
    [("{0}/t.csv: no t", "t.csv: no t"), ("{0} is empty", "it is empty"), ("no t in {0}", "no t in {0}")],
)
def test_the_path_of_a_refused_run_is_said_once(
    said: str, shown: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def act(folder: Path) -> Exit:
        raise UsageError(said.format(folder))

    assert for_each([tmp_path], act) == Exit.USAGE
    assert capsys.readouterr().err == f"hdrig: {tmp_path}: {shown.format(tmp_path)}\n"
