"""What a campaign leaves behind that ended before it had begun."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from rig.bench import BENCHES, read
from rig.campaign import summary
from rig.campaign.journal import Journal, new_journal, read_journal
from rig.campaign.leaving import came_to_something, swept
from rig.campaign.run import nothing_left
from rig.cli import main
from rig.core.errors import NotReady
from rig.core.operator import HangWeight, Rigging
from rig.runfile.folder import create_in
from tests.campaign.plans import REST, campaign, plan
from tests.commands.made_run import made_run

VERBS = (
    ["campaign", "quick"],
    ["run", "load-sweep"],
    ["run", "identify"],
    ["reproduce"],
    ["close-loop"],
    ["run", "kinematic-error"],
)


@pytest.fixture
def no_bus(tmp_path: Path) -> Path:
    """A bench whose bus is not there, with somebody to make the changes."""
    text = (BENCHES / "twin-can.toml").read_text(encoding="utf-8")
    bench = tmp_path / "bench.toml"
    bench.write_text(text.replace("/tmp/hdrig-twin", str(tmp_path / "nowhere")), encoding="utf-8")
    return bench


@pytest.mark.slow
@pytest.mark.parametrize("verb", VERBS, ids=" ".join)
def test_a_bus_that_is_missing_leaves_no_folder(
    verb: list[str], no_bus: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert main([*verb, "--bench", str(no_bus), "--out", str(out)]) == 3
    said = capsys.readouterr()
    assert "no CAN bus at" in said.err
    assert f"start `hdrig twin --serial {tmp_path}/nowhere/serial` in another terminal first" in said.err
    if verb != ["run", "kinematic-error"]:
        assert "no run was made, so the campaign folder" in said.err
    assert "goes on with it" not in said.err
    assert list(out.rglob("*")) == []


@pytest.mark.slow
def test_a_refusal_before_the_first_row_leaves_no_folder_and_is_one_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*_: object) -> None:
        raise NotReady("the rig is in fault: it is too hot")

    monkeypatch.setattr("rig.session.session.Session._refuse_now", refused)
    assert main(["campaign", "quick", "--out", str(tmp_path)]) == 3
    assert "hdrig: the rig is in fault: it is too hot" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_runs_over_a_wire_are_simulated_where_a_device_says_so(tmp_path: Path) -> None:
    journal = new_journal(tmp_path, campaign(REST), "virtual", [])
    journal.book["backend"] = "rig"
    assert not next(summary.lines(journal)).startswith("SIMULATED")
    journal.of_the_twin()
    assert next(summary.lines(read_journal(journal.folder))).startswith("SIMULATED campaign")


def interrupted(journal: Journal) -> None:
    with pytest.raises(NotReady), swept(journal):
        raise NotReady("the bus has gone")


@pytest.mark.parametrize("made", [lambda folder: None, lambda folder: create_in(folder / "checks", "other", {})])
def test_it_stays_where_something_was_recorded_and_says_how_it_ended(
    made: Callable[[Path], object], tmp_path: Path
) -> None:
    journal = new_journal(tmp_path, campaign(REST), "virtual", [])
    made(journal.folder)
    kept = came_to_something(journal)
    interrupted(journal)
    assert journal.folder.exists() is kept
    if kept:
        book = read_journal(journal.folder).book
        assert (book["status"], book["sentence"], book["process"]) == ("failed", "the bus has gone", None)


def test_a_campaign_that_cannot_be_taken_up_is_not_left_running(no_bus: Path, tmp_path: Path) -> None:
    journal = new_journal(tmp_path, campaign(REST, bench=read(str(no_bus))), "wall", [])
    (journal.folder / "plan.toml").write_text(plan(REST).text, encoding="utf-8")
    create_in(journal.folder / "checks", "other", {"status": "completed"})
    journal.close("stopped", "by the operator")
    assert main(["campaign", "--resume", str(journal.folder)]) == 3
    book = read_journal(journal.folder).book
    assert (book["status"], book["process"]) == ("failed", None)
    assert "no CAN bus at" in book["sentence"]


def test_a_campaign_with_nothing_left_to_make_is_closed_without_touching_the_rig(
    no_bus: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    journal = new_journal(tmp_path, campaign(REST, bench=read(str(no_bus))), "wall", [])
    (journal.folder / "plan.toml").write_text(plan(REST).text, encoding="utf-8")
    for index in journal.open_runs():
        journal.skip(index, "the operator")
    journal.close("stopped", "by the operator")
    assert main(["campaign", "--resume", str(journal.folder)]) == 0  # there is no bus: it was not opened
    assert read_journal(journal.folder).book["status"] == "completed"
    assert "nothing is moved" in "".join(capsys.readouterr())


def test_a_run_whose_analysis_was_killed_is_analysed_before_the_campaign_is_closed(
    no_bus: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    journal = new_journal(tmp_path, campaign(REST, bench=read(str(no_bus))), "wall", [])
    (journal.folder / "plan.toml").write_text(plan(REST).text, encoding="utf-8")
    journal.end(0, "done", "completed", made_run(journal.folder / "the-run"))
    journal.close("stopped", "killed")
    for _ in range(2):  # the second time it has its figure
        assert main(["campaign", "--resume", str(journal.folder)]) == 0
    assert (journal.folder / "the-run" / "result.json").exists()
    assert "arcsec" in read_journal(journal.folder).book["runs"][0]["figure"]
    assert "".join(capsys.readouterr()).count("run 1 was made and not analysed: the-run") == 1


def test_a_campaign_whose_runs_are_all_made_and_whose_weight_still_hangs_has_something_left(tmp_path: Path) -> None:
    journal = new_journal(tmp_path, campaign(REST), "virtual", [])
    for index in journal.open_runs():
        journal.skip(index, "the operator")
    assert nothing_left(journal)
    journal.show(HangWeight(3.0), Rigging(tau_ext=3.0), "+3.00 N·m on the output")
    assert not nothing_left(journal)
    journal.ask(HangWeight(0.0))  # asked for, and nobody knows whether it was taken off
    assert not nothing_left(journal)
