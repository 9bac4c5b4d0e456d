"""Events of a run reach its folder in order, and never hold up the loop that tells them."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest

from rig.bench import read
from rig.core.errors import Ended, RecorderError
from rig.procedures.standstill import Standstill
from rig.process.interrupts import Interrupts
from rig.runfile.events import EventLog, read_events
from rig.runfile.verify import verify
from rig.session import Session, behind, recording
from rig.session.done import nobody
from rig.session.log import SessionLog
from rig.session.observer import Observer
from rig.supervisor import Act, State


@pytest.fixture
def disk(monkeypatch: pytest.MonkeyPatch) -> threading.Event:
    """Set while it takes lines; each of them waits for that."""
    turns, append = threading.Event(), EventLog.append

    def slowly(self: EventLog, line: bytes) -> None:
        turns.wait()
        append(self, line)

    turns.set()
    monkeypatch.setattr(EventLog, "append", slowly)
    return turns


def test_a_disk_that_hangs_does_not_hold_up_a_stop_and_has_every_event_once_it_is_back(
    tmp_path: Path, disk: threading.Event
) -> None:
    log = SessionLog(lambda: 1.5, Observer())
    log.event("note", "before there is a folder")
    log.open(tmp_path)
    disk.clear()
    log.announce(State.STOPPING, Act.STOP, "asked by the operator")  # returns, or the test hangs as the loop would
    log.event("note", "the next one")
    assert [event["text"] for event in read_events(tmp_path)] == ["before there is a folder"]
    disk.set()
    log.close()
    assert [(event["kind"], event["text"], event["t"]) for event in read_events(tmp_path)] == [
        ("note", "before there is a folder", None),
        ("operator", "stopping: asked by the operator", 1.5),
        ("note", "the next one", 1.5),
    ]


def test_a_disk_that_stays_away_is_left_when_the_run_is_closed(
    tmp_path: Path, disk: threading.Event, monkeypatch: pytest.MonkeyPatch
) -> None:
    log = behind.Behind(EventLog(tmp_path))
    disk.clear()
    log.write("note", "long after", 0.0)
    with monkeypatch.context() as soon:
        soon.setattr(behind, "PATIENCE", 0.05)
        assert not log.close()
    disk.set()
    assert log.close()  # the disk came back after all


def test_what_a_disk_takes_after_the_run_was_closed_is_not_added_to_what_was_hashed(
    tmp_path: Path, disk: threading.Event, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The thread went on with the last events once the disk was back, and the run no longer agreed with its hash."""
    monkeypatch.setattr(behind, "PATIENCE", 0.05)
    monkeypatch.setattr(recording, "PATIENCE", 0.05)
    monkeypatch.setattr(Observer, "begun", lambda self, run: disk.clear() or nobody)
    with Session(read("twin"), "virtual", tmp_path, Interrupts()) as session:
        with pytest.raises(Ended, match=r"the last events of .* are missing: its disk did not take them in 0\.05 s"):
            session.run(Standstill(0.2))
        (held_up,) = (thread for thread in threading.enumerate() if thread.name == "events")
        disk.set()
        held_up.join()
    assert session.folder is not None
    assert [finding for finding in verify(session.folder) if finding.level == "error"] == []


def test_a_full_disk_keeps_the_events_that_come_after_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    append, refused = EventLog.append, iter([True])

    def full_once(self: EventLog, line: bytes) -> None:
        if next(refused, False):
            raise RecorderError("no space left on device")
        append(self, line)

    monkeypatch.setattr(EventLog, "append", full_once)
    log = behind.Behind(EventLog(tmp_path))
    log.write("note", "lost", 0.0)
    log.write("note", "kept", 0.1)
    assert log.close()
    assert [event["text"] for event in read_events(tmp_path)] == ["kept"]
