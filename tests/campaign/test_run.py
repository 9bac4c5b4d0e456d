"""A campaign to its end, stopped, tripped, lied to and resumed, in virtual time."""

from __future__ import annotations

import errno
import json
from pathlib import Path

import pytest

from rig.bench import read
from rig.campaign import dry_run, summary
from rig.campaign.changes import ByHand, Measure, deeds
from rig.campaign.journal import Journal, new_journal, read_journal, refuse_other_campaign
from rig.campaign.planner import Campaign
from rig.campaign.resume import take_up
from rig.core.errors import Exit, NotReady, RecorderError, UsageError
from rig.core.operator import LockOutput, Rigging
from rig.core.procedure import Procedure
from rig.runfile.process import this_process
from rig.runfile.verify import verify
from rig.session import Session, Watch
from rig.session.done import Done
from tests.campaign.plans import HEAD, LOADED, LOCKED, REST, campaign
from tests.campaign.rigs import Quiet, go_on, make

SMALL = (REST, LOADED + 'way = "down"\n', LOCKED)
GO_ON = HEAD + 'on_failure = "continue"\n'


def statuses(journal: Journal) -> list[str]:
    return [entry["status"] for entry in journal.book["runs"]]


Made = tuple[Exit, Journal, Quiet, Campaign]


of_one_campaign = pytest.mark.xdist_group("campaign run")  # it is made once, not once for every worker


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    planned = campaign(*SMALL)
    return (*make(tmp_path_factory.mktemp("runs"), planned), planned)


@of_one_campaign
@pytest.mark.slow
def test_every_run_is_made_in_a_folder_of_its_own_with_the_conditions_it_was_planned_for(made: Made) -> None:
    exit, journal, _, planned = made
    assert (exit, journal.book["status"], statuses(journal)) == (Exit.PASS, "completed", ["done"] * 3)
    for item, entry in zip(planned.items, journal.book["runs"], strict=True):
        manifest = json.loads((journal.folder / entry["run"] / "manifest.json").read_text())
        assert manifest["conditions"]["tau_ext"] == item.rigging.tau_ext
        assert manifest["conditions"]["output_locked"] is item.rigging.output_locked
        assert manifest["campaign"]["uid"] == journal.book["uid"]
        assert [f for f in verify(journal.folder / entry["run"]) if f.level == "error"] == []
        assert entry["figure"].startswith("figure of ")
        assert "/" not in entry["run"]  # a campaign is a folder of run folders, as `hdrig trace` reads it


@of_one_campaign
@pytest.mark.slow
def test_proofs_and_weighings_lie_aside_and_say_that_they_are_checks(made: Made) -> None:
    _, journal, _, _ = made
    checks = [json.loads(path.read_text()) for path in journal.folder.glob("checks/*/manifest.json")]
    assert {about["campaign"]["kind"] for about in checks} == {"check"}
    assert sorted(about["label"] for about in checks) == [
        "lock-check", "lock-check", "sign-and-scale", "sign-and-scale", "weigh", "weigh", "weigh",
    ]  # fmt: skip


@of_one_campaign
@pytest.mark.slow
def test_what_is_done_is_what_the_dry_run_says(made: Made) -> None:
    _, journal, desk, planned = made
    todo = list(deeds(list(enumerate(planned.items)), Rigging()))
    assert desk.begun == [deed.item for deed in todo if isinstance(deed, Measure)]
    assert journal.made == [deed.change for deed in todo if isinstance(deed, ByHand)]
    assert journal.rigging == Rigging()


@of_one_campaign
@pytest.mark.slow
def test_every_run_says_which_way_its_sweep_went_and_how_long_the_rig_had_run_before_it(made: Made) -> None:
    _, journal, _, _ = made
    found = [
        json.loads((journal.folder / entry["run"] / "manifest.json").read_text()) for entry in journal.book["runs"]
    ]
    assert [about["campaign"].get("way") for about in found] == [None, "down", None]
    times = [about["campaign"]["rig_time_s"] for about in found]
    assert times == sorted(times)
    assert times[0] > 20.0  # the proof and the tare
    assert times[1] - times[0] > 10.0  # the weighing between them


@of_one_campaign
@pytest.mark.slow
def test_nothing_is_made_again_in_a_campaign_that_is_complete(made: Made) -> None:
    _, journal, _, planned = made
    assert read_journal(journal.folder).open_runs() == []
    assert list(dry_run.lines(planned, [])) == ["every run is made: nothing is left to do"]


@pytest.mark.slow
def test_a_stopped_campaign_goes_on_where_it_left_off_as_often_as_it_is_stopped(tmp_path: Path) -> None:
    planned = campaign(REST, LOADED, REST)
    exit, journal, _ = make(tmp_path, planned, stop_at=1)
    assert (exit, journal.book["status"], statuses(journal)) == (
        Exit.STOPPED, "stopped", ["stopped", "planned", "planned"],
    )  # fmt: skip
    again = read_journal(journal.folder)
    refuse_other_campaign(again, planned)
    take_up(again)
    exit, again, desk = go_on(again, planned, stop_at=2, requests=2)
    assert (exit, statuses(again)) == (Exit.HALTED, ["done", "stopped", "planned"])
    assert again.rigging.tau_ext == 2.0
    take_up(again)
    exit, again, desk = go_on(again, planned)
    assert (exit, again.book["status"], statuses(again)) == (Exit.PASS, "completed", ["done"] * 3)
    assert desk.begun == list(planned.items[1:])
    assert desk.said[0] == "by hand: take the weight off the output"  # proof and tare need it off
    attempts = again.book["runs"][1]["attempts"]
    assert [attempt["status"] for attempt in attempts] == ["stopped", "done"]
    assert (again.folder / attempts[0]["run"] / "manifest.json").exists()


@pytest.mark.slow
def test_a_change_that_is_not_shown_ends_the_campaign_and_is_undone_before_it_goes_on(tmp_path: Path) -> None:
    planned = campaign(LOCKED, head=GO_ON)
    journal = new_journal(tmp_path, planned, "virtual", [])
    exit, journal, _ = go_on(journal, planned, instead={LockOutput(): None})
    assert (exit, journal.book["status"]) == (Exit.NOT_READY, "failed")
    assert "not locked" in journal.book["sentence"]
    assert journal.pending == LockOutput()
    assert statuses(journal) == ["planned"]
    take_up(journal)
    exit, journal, desk = go_on(journal, planned)
    assert (exit, statuses(journal), journal.pending) == (Exit.PASS, ["done"], None)
    assert desk.said[0] == "by hand: remove the lock pin of the output"


@pytest.mark.slow
def test_a_run_that_trips_is_recorded_in_words_and_ends_the_campaign(tmp_path: Path) -> None:
    exit, journal, _ = make(tmp_path, campaign(REST, REST), trip_at=1)
    assert (exit, journal.book["status"]) == (Exit.TRIPPED, "failed")
    assert statuses(journal) == ["failed", "planned"]
    assert "it is too hot" in journal.book["runs"][0]["sentence"]
    assert (journal.folder / journal.book["runs"][0]["run"] / "samples.parquet").exists()


@pytest.mark.slow
@pytest.mark.parametrize("lost", [True, False], ids=["the run too", "the book alone"])
def test_a_disk_that_fills_ends_the_campaign_as_it_ends_a_run(
    lost: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    honest = Session.run

    def full(path: Path, data: bytes) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    def run(self: Session, procedure: Procedure, watch: Watch) -> Done:
        done = honest(self, procedure, watch)
        monkeypatch.setattr("rig.campaign.journal.write_atomic", full)
        if lost:
            raise RecorderError("the recorder cannot write")
        return done

    monkeypatch.setattr(Session, "run", run)
    exit, _, desk = make(tmp_path, campaign(REST, REST))
    assert exit is Exit.TRIPPED
    assert "campaign.json cannot be written: No space left on device" in desk.said[-1]
    assert ("run failed: the recorder cannot write" in desk.said) is lost
    assert len(desk.begun) == 1


@pytest.mark.slow
@pytest.mark.long
def test_where_the_plan_says_so_a_person_clears_the_fault_and_the_campaign_goes_on(tmp_path: Path) -> None:
    exit, journal, _ = make(tmp_path, campaign(REST, REST, head=GO_ON), trip_at=1)
    assert (exit, journal.book["status"]) == (Exit.TRIPPED, "failed")
    assert statuses(journal) == ["failed", "done"]
    assert any(note["text"].startswith("fault cleared by hand: a device reports") for note in journal.book["notes"])


def test_a_run_that_was_stopped_before_it_had_a_folder_never_began(tmp_path: Path) -> None:
    journal = new_journal(tmp_path, campaign(REST, REST), "virtual", [])
    journal.end(0, "stopped", "stopped by the operator", None)
    journal.end(1, "stopped", "stopped by the operator", journal.folder / "rest")
    marks = [line[6:17].strip() for line in summary.lines(journal) if line[:4].strip().isdigit()]
    assert marks == ["not begun", "stopped"]


@pytest.mark.slow
def test_a_skipped_run_is_not_made_and_says_who_skipped_it(tmp_path: Path) -> None:
    planned = campaign(LOADED, REST)
    journal = new_journal(tmp_path, planned, "virtual", [])
    journal.skip(0, "maria")
    exit, journal, desk = go_on(journal, planned)
    assert (exit, statuses(journal)) == (Exit.PASS, ["skipped", "done"])
    assert (desk.begun, journal.made) == ([planned.items[1]], [])
    assert any("skipped by maria" in line for line in summary.lines(journal))


def test_another_plan_another_bench_or_another_order_is_refused_with_a_sentence(tmp_path: Path) -> None:
    journal = new_journal(tmp_path, campaign(REST), "virtual", [])
    with pytest.raises(UsageError, match="the plan is not the one this campaign began with"):
        refuse_other_campaign(journal, campaign(REST, REST))
    with pytest.raises(UsageError, match="the bench is not the one this campaign began with"):
        refuse_other_campaign(journal, campaign(REST, bench=read("twin", ["control.Kp=4"])))
    journal.book["runs"][0]["parameters"] = {"duration": 0.3}
    with pytest.raises(UsageError, match="this hdrig plans other runs"):
        refuse_other_campaign(journal, campaign(REST))


def test_a_campaign_that_is_being_made_is_not_taken_up_by_another_process(tmp_path: Path) -> None:
    journal = new_journal(tmp_path, campaign(REST), "virtual", [])
    assert journal.book["process"] == this_process()
    with pytest.raises(NotReady, match="is being made by process"):
        take_up(read_journal(journal.folder))


def test_of_two_that_read_a_stopped_campaign_one_alone_goes_on_with_it(tmp_path: Path) -> None:
    stopped = new_journal(tmp_path, campaign(REST), "virtual", [])
    stopped.close("stopped", "stopped by the operator")
    first, second = read_journal(stopped.folder), read_journal(stopped.folder)
    take_up(first)
    with pytest.raises(NotReady, match="is being made by process"):
        take_up(second)
    assert len(read_journal(stopped.folder).book["sessions"]) == 2


def test_a_folder_that_is_no_campaign_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="is not a campaign folder"):
        read_journal(tmp_path)
    (tmp_path / "campaign.json").write_text("{")
    with pytest.raises(UsageError, match="is not JSON"):
        read_journal(tmp_path)


@pytest.mark.slow
@pytest.mark.long
def test_a_note_of_the_campaign_stands_in_every_run_and_check_also_of_a_later_session(tmp_path: Path) -> None:
    planned = campaign(*SMALL)
    journal = new_journal(tmp_path, planned, "virtual", [])
    assert journal.note("new grease") == "new grease"
    _, journal, _ = go_on(journal, planned, stop_at=2)
    take_up(journal)
    go_on(journal, planned)
    found = {path.parent.name: json.loads(path.read_text()) for path in journal.folder.rglob("manifest.json")}
    assert len({about["campaign"]["session"] for about in found.values()}) == 2
    assert {str(about["conditions"]["note"]).split("; ")[0] for about in found.values()} == {"new grease"}
    assert "note: new grease" in list(summary.lines(journal))


@pytest.mark.slow
@pytest.mark.long
def test_a_run_whose_analysis_was_killed_is_analysed_before_anything_moves(tmp_path: Path) -> None:
    planned = campaign(REST, REST)
    _, journal, _ = make(tmp_path, planned, stop_at=2)
    take_up(journal)
    told = journal.book["runs"][0].pop("figure")
    exit, _, desk = go_on(journal, planned)
    assert (exit, journal.book["runs"][0]["figure"]) == (Exit.PASS, told)
    first = desk.said.index(told)
    assert first < next(k for k, said in enumerate(desk.said) if said.startswith("sign and scale"))
