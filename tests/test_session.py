"""What a session does when something is amiss around a run: its folder is closed, a fault stays."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from rig.bench import read
from rig.core.devices import UNGUARDED, Drive, Watchdog
from rig.core.errors import Ended, NotReady, RecorderError
from rig.core.operator import Change, HangWeight, Operator, Reassemble, Rigging
from rig.core.sample import Sample
from rig.instruments import Instruments
from rig.procedures.standstill import Standstill
from rig.procedures.weigh import Weigh
from rig.process.interrupts import Interrupts
from rig.runfile.events import read_events
from rig.runfile.run import Run
from rig.session import Session, Watch
from rig.session.observer import Begun, Observer
from rig.supervisor import Act, State


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Session]:
    with Session(read("twin"), "virtual", tmp_path, Interrupts()) as made:
        yield made


@pytest.mark.parametrize(
    "where", ["rig.recorder.Recorder.__init__", "rig.recorder.Recorder.start", "rig.session.observer.Observer.begun"]
)
def test_a_run_that_cannot_begin_closes_its_folder_and_leaves_no_recorder(
    session: Session, monkeypatch: pytest.MonkeyPatch, where: str
) -> None:
    def refused(*_: object, **__: object) -> None:
        raise RecorderError("no room for it")

    monkeypatch.setattr(where, refused)
    with pytest.raises(RecorderError, match="no room for it"):
        session.run(Standstill(1.0))
    assert session.folder is not None
    manifest = json.loads((session.folder / "manifest.json").read_text())
    assert manifest["status"] != "running"
    assert "no room for it" in manifest["exit_reason"]


def test_an_observer_that_breaks_leaves_no_run_open(session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise RuntimeError("the line is gone")

    monkeypatch.setattr(Observer, "ended", broken)
    with pytest.raises(RuntimeError, match="the line is gone"):
        session.run(Standstill(0.5))
    assert session.folder is not None
    manifest = json.loads((session.folder / "manifest.json").read_text())
    assert (manifest["status"], manifest["rows"]) == ("completed", 500)


def test_an_observer_that_breaks_as_a_bench_is_connected_leaves_no_device_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise RuntimeError("the line is gone")

    closed: list[Instruments] = []
    monkeypatch.setattr(Observer, "event", broken)
    monkeypatch.setattr(Instruments, "close", lambda self: closed.append(self))
    with (
        pytest.raises(RuntimeError, match="the line is gone"),
        Session(read("twin"), "virtual", tmp_path, Interrupts()),
    ):
        pass
    assert len(closed) == 1


def test_a_hold_asked_for_while_nothing_ran_holds_no_run(session: Session) -> None:
    """The next run held at its first tick, and did nothing."""
    session.interrupts.hold()
    done = session.run(Standstill(0.5))
    assert done.ending.status == "completed"
    assert any("while nothing ran" in event["text"] for event in read_events(done.folder))


@pytest.mark.parametrize(
    ("watchdog", "is_said"), [(None, False), (Watchdog("time-out, 100 ms", is_proven=True), False), (Watchdog(), True)]
)
def test_a_drive_that_nothing_would_stop_is_said_to_be_one_before_anything_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, watchdog: Watchdog | None, is_said: bool
) -> None:
    monkeypatch.setattr(Drive, "watchdog", watchdog)
    with Session(read("twin"), "virtual", tmp_path, Interrupts()) as session:
        done = session.run(Standstill(0.5))
    told = [event["text"] for event in read_events(done.folder)]
    assert (UNGUARDED in told) == is_said
    manifest = json.loads((done.folder / "manifest.json").read_text())
    assert manifest.get("watchdog") == (watchdog and watchdog._asdict())


class Asked(Operator):
    """At the page, beside a twin in this process (it begins anew) or in one of its own."""

    def __init__(self, begins_anew: bool) -> None:
        self.begins_anew = begins_anew
        self.remade: list[Change] = []

    def make(self, change: Change) -> None:
        raise AssertionError(f"asked for {change.words()}, which was done before")

    def remake(self, change: Change) -> None:
        self.remade.append(change)


@pytest.mark.parametrize("begins_anew", [True, False])
def test_a_campaign_taken_up_makes_again_what_was_made_where_the_rig_begins_anew_and_nowhere_else(
    session: Session, begins_anew: bool
) -> None:
    session.instruments.operator, session.hand = None, (hand := Asked(begins_anew))
    made: list[Change] = [Reassemble(0.1), HangWeight(10.0)]
    session.restore(made, left := Rigging(tau_ext=10.0))
    assert hand.remade == (made if begins_anew else [])
    assert session.rigging == left


@pytest.mark.parametrize(
    ("carries", "weight", "is_said"),
    [(12.7, 0.0, True), (-12.7, 0.0, True), (-10.1, 10.0, False), (0.9, 0.0, False), (None, 0.0, False)],
)
def test_a_shaft_that_carries_what_no_weight_explains_is_said_before_anything_is_energised(
    session: Session, monkeypatch: pytest.MonkeyPatch, carries: float | None, weight: float, is_said: bool
) -> None:
    session.instruments.operator, session.rigging = None, Rigging(tau_ext=weight)  # a rig that was there before
    monkeypatch.setattr(Instruments, "still_carried", lambda self, fresh: carries)
    told: list[str] = []
    monkeypatch.setattr(session.observer, "warned", told.append, raising=False)
    for _ in range(2):
        session.finding(Standstill(0.2))
    assert len(told) == 2 * is_said  # before every run: it may be another who comes for the second
    assert all(text.startswith("before anything is energised the shaft carries") for text in told)


def test_a_fault_is_not_left_while_the_drive_does_not_confirm_that_its_torque_is_off(
    session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    session.supervisor.act(Act.TRIP, "over-current")
    with monkeypatch.context() as deaf:
        deaf.setattr(session.instruments.drive, "halt", lambda: False)
        with pytest.raises(NotReady, match="the fault stays: the drive did not confirm that its torque is off"):
            session.reset()
        assert session.supervisor.state is State.FAULT
    session.reset()
    assert session.supervisor.state is State.CONNECTED


def test_a_motor_that_a_weight_turns_is_not_energised(session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    energised: list[object] = []
    monkeypatch.setattr(session.instruments.drive, "enable", energised.append)
    assert session.instruments.operator is not None
    session.instruments.operator.make(HangWeight(30.0))
    session.instruments.clock.wait_until(session.instruments.clock.now() + 0.5)
    refused = r"the motor turns at -?\d+ rpm though nothing is energised, and has not come to rest in 5 s"
    with pytest.raises(NotReady, match=refused):
        session.run(Standstill(1.0))
    assert not energised
    assert session.folder is None


def test_a_weighing_says_what_it_found_beside_what_was_expected(session: Session) -> None:
    assert session.instruments.operator is not None
    session.instruments.operator.make(HangWeight(5.0))
    said = session.run(Weigh(tau_ext=4.0)).ending.finding.sentence
    found = re.search(r"; (\S+) N·m on the output by that, \+4 N·m expected", said)
    assert found
    assert float(found.group(1)) == pytest.approx(5.0, abs=0.1)


def test_who_asks_for_an_end_is_not_kept_waiting_for_a_motor_that_turns(session: Session) -> None:
    assert session.instruments.operator is not None
    session.instruments.operator.make(HangWeight(30.0))
    clock = session.instruments.clock
    clock.wait_until(clock.now() + 0.5)
    since, session.interrupts.count = clock.now(), 0
    looked = session.instruments.look

    def stopped() -> Sample:
        session.interrupts.request()
        return looked()

    session.instruments.look = stopped  # type: ignore[method-assign]
    with pytest.raises(Ended, match="nothing more was started"):
        session.run(Standstill(1.0))
    assert clock.now() - since < 1.0


def test_who_asks_for_an_end_is_not_kept_waiting_for_rest_before_a_change_by_hand(session: Session) -> None:
    assert session.instruments.operator is not None
    session.instruments.operator.make(HangWeight(30.0))
    clock, wait = session.instruments.clock, session.instruments.clock.wait_until
    wait(clock.now() + 0.5)
    since = clock.now()
    session.interrupts.request()
    with pytest.raises(Ended, match="nothing more was started"):
        session.come_to_rest()
    assert clock.now() - since < 1.0


def test_what_others_build_on_names_its_folder_where_it_came_to_no_end(session: Session) -> None:
    begun = Observer.begun

    def stopped(self: Observer, run: Begun) -> Watch:
        session.interrupts.request()
        return begun(self, run)

    session.observer.begun = stopped.__get__(session.observer)  # type: ignore[method-assign]
    with pytest.raises(Ended, match="did not finish") as ended:
        session.finding(Standstill(1.0))
    assert ended.value.__notes__ == [f"what was recorded is in {session.folder}"]


def test_a_motor_that_comes_to_rest_meanwhile_is_waited_for(session: Session) -> None:
    assert session.instruments.operator is not None
    session.instruments.operator.make(HangWeight(30.0))
    session.instruments.clock.wait_until(session.instruments.clock.now() + 0.5)
    session.instruments.operator.make(HangWeight(0.0))
    done = session.run(Standstill(1.0))
    assert done.ending.status == "completed"
    rows = Run.open(done.folder).column("theta_m")
    assert rows is not None
    assert abs(rows[-1] - rows[0]) < 0.01
