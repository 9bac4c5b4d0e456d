"""A new run folder, its manifest, its events."""

from __future__ import annotations

import errno
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from rig.core.errors import DataError, Exit, HdrigError, NotReady, RecorderError, UsageError
from rig.runfile import manifest
from rig.runfile.events import EventLog, mend_events, read_events
from rig.runfile.folder import create, create_hidden, shown
from rig.runfile.process import is_being_made, lives, started, this_process
from tests.runfile.rows import manifest_of, new_folder

GEAR = {"gear": {"ratio": 50, "serial": "SN0042"}}


def test_the_folder_says_when_what_and_which_gear(tmp_path: Path) -> None:
    folder = create(tmp_path, "kinematic_error", {**GEAR, "started_utc": "2026-11-20T03:47:10+02:00", "uid": "3f9c0"})
    assert folder == tmp_path / "2026-11-20" / "0147-kinematic-error-SN0042-3f9c"


def test_a_serial_that_is_no_file_name_is_made_one(tmp_path: Path) -> None:
    folder = create(tmp_path, "friction", {"gear": {"ratio": 50, "serial": "../SN 1/ä"}})
    assert re.fullmatch(r"\d{4}-friction-\.\.-SN-1--[0-9a-f]{4}", folder.name)
    assert folder.parent.parent == tmp_path
    assert "no-serial" in create(tmp_path, "friction", {"gear": {"ratio": 50}}).name


def test_two_runs_of_one_minute_and_one_uid_get_two_folders(tmp_path: Path) -> None:
    about = {**GEAR, "started_utc": "2026-11-20T01:47:00+00:00", "uid": "3f9c"}
    assert len({create(tmp_path, "friction", about) for _ in range(5)}) == 5


def test_a_run_made_hidden_gets_a_name_of_its_own_when_it_is_whole(tmp_path: Path) -> None:
    about = {**GEAR, "started_utc": "2026-11-20T01:47:00+00:00", "uid": "3f9c"}
    day = tmp_path / "2026-11-20"
    hidden = [create_hidden(tmp_path, "friction", about) for _ in range(2)]
    assert hidden[0] == day / ".0147-friction-SN0042-3f9c"
    taken = create(tmp_path, "friction", about)
    found = [shown(folder) for folder in hidden]
    assert len({taken, *found}) == 3
    assert all(folder.name.startswith("0147-friction-SN0042-") for folder in found)
    assert sorted(day.iterdir()) == sorted([taken, *found])


def test_the_manifest_is_there_first_and_says_running(tmp_path: Path) -> None:
    folder = create(tmp_path, "friction", {**GEAR, "backend": "sim", "operator": "ö"}, "name = 'twin'\n")
    about = manifest_of(folder)
    assert about["schema"] == "hdrig.run/1"
    assert about["status"] == "running"
    assert about["procedure"] == "friction"
    assert about["operator"] == "ö"
    assert about["clock"]["utc_at_start"] == about["started_utc"]
    assert about["process"]["pid"] == os.getpid()
    assert (folder / "bench.toml").read_text() == "name = 'twin'\n"


@pytest.mark.parametrize("root", ["/proc", "/dev/null/runs"])  # neither can be written to, not even by root
def test_where_nothing_can_be_written_nothing_is_begun(root: str) -> None:
    with pytest.raises(NotReady, match=f"no run folder can be made in {root}: "):
        create(root, "friction", GEAR)


def test_a_change_that_cannot_be_written_leaves_the_manifest_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = new_folder(tmp_path)
    before = manifest_of(folder)

    def full(handle: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space"):
        manifest.update(folder, status="completed")
    assert manifest_of(folder) == before
    assert sorted(p.name for p in folder.iterdir()) == ["bench.toml", "manifest.json"]


def test_none_removes_a_key(tmp_path: Path) -> None:
    folder = new_folder(tmp_path)
    assert "ring" in manifest.update(folder, ring="/dev/shm/x")
    assert "ring" not in manifest.update(folder, ring=None)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (None, "is not a run folder: it has no manifest.json"),
        ("{", "is not JSON"),
        ("[]", 'manifest.json is a list, expected an object with schema "hdrig.run/1"'),
        ("null", 'manifest.json is null, expected an object with schema "hdrig.run/1"'),
        ("true", "manifest.json is true, expected an object"),
        ("2.5", "manifest.json is a number, expected an object"),
        ('"x"', "manifest.json is text, expected an object"),
        ('{"schema": [1]}', r'has schema \[1\], expected "hdrig.run/1"'),
        ('{"schema": "hdrig.run/9"}', 'has schema "hdrig.run/9", expected "hdrig.run/1"'),
        ("{}", 'has no schema, expected "hdrig.run/1"'),
    ],
)
def test_a_manifest_that_is_none_is_refused_with_a_sentence(tmp_path: Path, text: str | None, sentence: str) -> None:
    if text is not None:
        (tmp_path / "manifest.json").write_text(text)
    with pytest.raises(UsageError, match=sentence):
        manifest.read(tmp_path)


def test_each_event_is_a_line_with_its_times_and_its_words(tmp_path: Path) -> None:
    with EventLog(tmp_path, utc=lambda: "2026-11-20T01:47:00+00:00") as events:
        events.write("state", "running")
        events.write("trip", "following error 12.1 deg", t=1.25, limit=10.0)
        assert len(read_events(tmp_path)) == 2  # with the system already, not at close
    assert json.loads((tmp_path / "events.jsonl").read_text().splitlines()[1]) == {
        "t": 1.25,
        "utc": "2026-11-20T01:47:00+00:00",
        "kind": "trip",
        "text": "following error 12.1 deg",
        "limit": 10.0,
    }


def test_a_line_torn_by_a_kill_spoils_no_other(tmp_path: Path) -> None:
    with EventLog(tmp_path) as events:
        events.write("note", "whole")
    with open(tmp_path / "events.jsonl", "a") as file:
        file.write('{"t": 1.0, "ki')
    mend_events(tmp_path)
    with EventLog(tmp_path) as events:
        events.write("recover", "after")
    assert [e["text"] for e in read_events(tmp_path)] == ["whole", "after"]
    before = (tmp_path / "events.jsonl").read_bytes()
    mend_events(tmp_path)
    assert (tmp_path / "events.jsonl").read_bytes() == before


def test_a_run_without_events_has_none(tmp_path: Path) -> None:
    assert read_events(tmp_path) == []
    mend_events(tmp_path)


def test_events_that_cannot_be_written_are_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(RecorderError, match=r"events of the run cannot be written to .*gone"):
        EventLog(tmp_path / "gone")


def test_a_process_is_told_apart_from_a_later_one_of_the_same_number() -> None:
    me = this_process()
    assert lives(me)
    assert is_being_made({"process": me})
    assert not is_being_made({})
    assert not lives({**me, "started": me["started"] + 1})
    assert not lives({**me, "started": 0})
    assert not lives({**me, "host": "another"})
    assert not lives({**me, "pid": 0})


def test_a_killed_process_that_nobody_has_reaped_is_dead() -> None:
    process = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    assert started(process.pid)
    process.kill()
    while started(process.pid):
        pass
    assert process.wait() == -9
    assert process.stdin is not None
    process.stdin.close()


@pytest.mark.parametrize(
    ("number", "kind", "code"),
    [
        (errno.EACCES, NotReady, Exit.USAGE),
        (errno.EROFS, DataError, Exit.USAGE),
        (errno.ENOSPC, NotReady, Exit.NOT_READY),
        (errno.EACCES, RecorderError, Exit.TRIPPED),  # a run is being recorded: it ends as such
    ],
)
def test_a_place_nobody_may_use_ends_with_the_code_of_one(number: int, kind: type[HdrigError], code: Exit) -> None:
    with pytest.raises(kind, match=r"^x cannot be opened: ") as refused, manifest.told(kind, "x cannot be opened"):
        raise OSError(number, os.strerror(number))
    assert refused.value.exit is code
