"""The station's acts, in this process: what goes out on its line, in order."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from rig.live.switches import Switches
from rig.station.channel import Channel
from rig.station.interrupts import Panel
from rig.station.jobs import JOBS
from rig.station.station import Station


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
