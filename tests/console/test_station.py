"""The station's acts, in this process: what goes out on its line, in order."""

from __future__ import annotations

import shutil
import socket
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from rig.doctor.disk import check_disk
from rig.instruments import Instruments
from rig.live.switches import Switches
from rig.station import jobs
from rig.station.channel import Channel
from rig.station.interrupts import Panel
from rig.station.jobs import JOBS
from rig.station.station import LATCHED, Station
from rig.supervisor import Act, State
from tests.runfile.test_room import Usage


@pytest.fixture
def line(tmp_path: Path) -> Iterator[tuple[Station, Channel]]:
    ours, theirs = (Channel(end) for end in socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET))
    switches = Switches.create()
    station = Station(theirs, switches, Panel(Switches.attach(switches.path)), tmp_path, JOBS)
    yield station, ours
    station.disconnect()
    switches.unlink()
    switches.close()
    ours.close()
    theirs.close()


def told(message: dict[str, Any]) -> tuple[str, str]:
    """Its kind, and of a picture the job it shows, of an event what kind that is."""
    kind = str(message["kind"])
    inner = {"status": ("status", "job"), "event": ("event", "kind")}.get(kind)
    return kind, message[inner[0]][inner[1]] if inner else ""


def test_a_refused_act_is_told_before_the_station_is_free_again(line: tuple[Station, Channel]) -> None:
    station, page = line
    bench = {"bench": "twin-can", "overrides": ["bus.rig.channel=/nowhere/can"]}
    station.take({"act": "connect", "id": "1", "until": None, **bench})
    said = [told(message) for message in page.receive(1.0)]
    free = said.index(("status", ""))
    assert ("event", "refused") in said[:free], said
    assert ("reply", "") in said[:free], said


def test_the_check_looks_at_the_disk_that_the_runs_of_this_station_go_to(
    line: tuple[Station, Channel], monkeypatch: pytest.MonkeyPatch
) -> None:
    """It looked at the folder the console was started in, which may be on another disk."""
    station, _ = line
    looked: list[str] = []

    def disk_usage(path: Path) -> Usage:
        looked.append(str(path))
        return Usage(int(1e12), 0, int(1e9))

    monkeypatch.setattr(shutil, "disk_usage", disk_usage)
    monkeypatch.setattr(jobs, "CHECKS", (check_disk,))
    station.take({"act": "check", "id": "1", "until": None, "bench": "twin"})
    assert looked == [str(station.root)]
    (found,) = station.status.checks
    assert found["text"].startswith("1.0 GB free, ")


@pytest.mark.slow
@pytest.mark.parametrize("confirms", [True, False])
def test_a_defect_in_an_act_is_a_sentence_and_the_station_keeps_the_bench_without_torque(
    line: tuple[Station, Channel], monkeypatch: pytest.MonkeyPatch, confirms: bool
) -> None:
    """The process ended with a traceback, and the bench was let go."""

    def broken(station: Station, message: Mapping[str, Any]) -> None:
        station.need().instruments.drive.enable()
        monkeypatch.setattr(Instruments, "safe", safe)
        raise ZeroDivisionError("a bug")

    def safe(instruments: Instruments) -> bool:
        taken_off.append(instruments.drive.halt())
        return confirms

    station, page = line
    taken_off: list[bool] = []
    station.jobs = {**JOBS, "jog": broken}
    station.take({"act": "connect", "id": "1", "until": None, "bench": "twin", "clock": "virtual"})
    page.receive(1.0)
    station.take({"act": "jog", "id": "2", "until": None})
    said = [m["event"]["text"] for m in page.receive(1.0) if m["kind"] == "event" and m["event"]["kind"] == "error"]
    assert said[-1].startswith("internal error, please report it: ZeroDivisionError: a bug in ")
    assert ("TORQUE OFF NOT CONFIRMED" in said[-1]) is not confirms
    assert taken_off == [True]
    assert station.need().supervisor.state is (State.CONNECTED if confirms else State.FAULT)
    station.attend()  # it goes on


def test_a_halt_pressed_while_something_else_than_a_run_is_carried_out_is_not_lost(
    line: tuple[Station, Channel], monkeypatch: pytest.MonkeyPatch
) -> None:
    """During a check, say: nothing looked at it, and afterwards it counted as seen."""
    station, page = line
    station.take({"act": "connect", "id": "1", "until": None, "bench": "twin", "clock": "virtual"})
    station.jobs = {**JOBS, "check": lambda station, message: station.switches.halt()}
    station.take({"act": "check", "id": "2", "until": None})
    page.receive(1.0)
    station.attend()
    said = [m["event"]["text"] for m in page.receive(1.0) if m["kind"] == "event"]
    assert said == ["halted while nothing ran: torque off, confirmed by the drive"]


def test_a_fault_is_not_cleared_by_connecting_anew(line: tuple[Station, Channel]) -> None:
    """Two clicks did what a reset does, and nobody had said that the rig was seen to."""
    station, _ = line
    bench = {"until": None, "bench": "twin", "clock": "virtual"}
    station.take({"act": "connect", "id": "1", **bench})
    station.need().supervisor.act(Act.TRIP, "shaft torque 71.00 N·m, limit ±60.00 N·m")
    for _ in range(2):  # and said once, however often
        station.take({"act": "disconnect", "id": "2", "until": None})
        station.take({"act": "connect", "id": "3", **bench})
    supervisor = station.need().supervisor
    assert supervisor.state is State.FAULT
    assert supervisor.fault == f"shaft torque 71.00 N·m, limit ±60.00 N·m{LATCHED}"
    station.take({"act": "reset", "id": "4", "until": None})
    assert supervisor.state is State.CONNECTED
    station.take({"act": "disconnect", "id": "5", "until": None})
    station.take({"act": "connect", "id": "6", **bench})
    assert station.need().supervisor.state is State.CONNECTED
