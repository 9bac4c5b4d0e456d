"""A run that was done and whose folder is gone, damaged or renamed since: made again, or found under its other name."""

from __future__ import annotations

import errno
import shutil
from pathlib import Path

import pytest

from rig.campaign import summary
from rig.campaign.journal import Journal, read_journal
from rig.campaign.lost import lost_runs
from rig.campaign.planner import Campaign
from rig.campaign.resume import take_up
from rig.campaign.run import close_settled, nothing_left
from rig.cli import main
from rig.core.errors import Exit
from tests.campaign.plans import REST, campaign
from tests.campaign.rigs import go_on, make

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("lost runs")]  # one campaign is made, for all of them


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Campaign]:
    """A campaign of two runs, complete."""
    planned = campaign(REST, REST)
    exit, journal, _ = make(tmp_path_factory.mktemp("runs"), planned)
    assert exit is Exit.PASS
    return journal.folder, planned


@pytest.fixture
def made(whole: tuple[Path, Campaign], tmp_path: Path) -> tuple[Journal, Path, Campaign]:
    """A copy of its book, the folder of its second run, and what was planned."""
    folder, planned = whole
    journal = read_journal(Path(shutil.copytree(folder, tmp_path / folder.name)))
    return journal, journal.folder / journal.book["runs"][1]["run"], planned


Made = tuple[Journal, Path, Campaign]


def test_a_run_whose_folder_is_gone_is_made_again_and_no_other(made: Made) -> None:
    journal, second, planned = made
    shutil.rmtree(second)
    said = f"run 2 is to be made again: its folder {second.name} is gone"
    assert take_up(journal) == [said]
    assert (journal.open_runs(), "figure" in journal.book["runs"][1]) == ([1], False)
    assert f"      {said}" in list(summary.lines(journal))
    exit, journal, desk = go_on(journal, planned)
    assert (exit, len(desk.begun), journal.book["status"]) == (Exit.PASS, 1, "completed")
    assert [one["status"] for one in journal.book["runs"][1]["attempts"]] == ["done", "lost", "done"]
    assert lost_runs(journal) == {}


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("samples.parquet", "samples.parquet cannot be read: it is damaged or cut short (100 bytes)"),
        ("manifest.json", "it has samples and no manifest.json; hdrig recover makes it anew"),
    ],
)
def test_a_run_that_cannot_be_read_counts_as_not_made_and_its_folder_stays(made: Made, name: str, why: str) -> None:
    journal, second, _ = made
    data = (second / name).read_bytes()
    (second / name).unlink()
    if name == "samples.parquet":
        (second / name).write_bytes(data[:100])
    [said] = take_up(journal)
    assert said.startswith(f"run 2 is to be made again: its folder {second.name} cannot be used: {why}")
    assert (journal.open_runs(), second.exists()) == ([1], True)


def test_a_run_that_was_renamed_is_found_by_its_uid(made: Made) -> None:
    journal, second, _ = made
    second.rename(second.with_name("umbenannt Größe"))
    assert lost_runs(journal) == {}
    assert take_up(journal) == [f"run 2 lies in umbenannt Größe now, it was {second.name}"]
    assert nothing_left(journal)
    assert read_journal(journal.folder).book["runs"][1]["run"] == "umbenannt Größe"


@pytest.mark.long
def test_a_lost_run_that_somebody_skips_leaves_the_campaign_incomplete(made: Made) -> None:
    journal, second, planned = made
    assert close_settled(journal) is Exit.PASS
    shutil.rmtree(second)
    take_up(journal)
    journal.skip(1, "maria")
    assert close_settled(journal) is Exit.INCOMPLETE
    exit, *_ = go_on(journal, planned)
    assert exit is Exit.INCOMPLETE


def test_a_dry_run_says_what_is_to_be_made_again_and_writes_nothing(
    made: Made, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    journal, second, planned = made
    shutil.rmtree(second)
    monkeypatch.setattr("rig.commands.campaign.planned", lambda *given: planned)
    monkeypatch.setattr("rig.commands.campaign.read_plan", lambda source: planned.plan)
    before = (journal.folder / "campaign.json").read_bytes()
    assert main(["campaign", "--resume", str(journal.folder), "--dry-run"]) == Exit.PASS
    said = capsys.readouterr().out
    assert f"run 2 is to be made again: its folder {second.name} is gone" in said
    assert "total       1 runs" in said
    assert (journal.folder / "campaign.json").read_bytes() == before


def test_a_campaign_in_a_folder_that_nobody_may_write_to_is_a_place(
    made: Made, monkeypatch: pytest.MonkeyPatch
) -> None:
    journal, _, planned = made

    def shut(path: Path, data: bytes) -> None:
        raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr("rig.commands.campaign.read_plan", lambda source: planned.plan)
    monkeypatch.setattr("rig.campaign.journal.write_atomic", shut)
    assert main(["campaign", "--resume", str(journal.folder)]) == Exit.USAGE
