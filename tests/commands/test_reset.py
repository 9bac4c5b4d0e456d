"""hdrig run --reset leaves a latched fault by an explicit act; without it a fault stays in the way of every run."""

from __future__ import annotations

import argparse
import io
from pathlib import Path

import pytest

from rig.commands import run
from rig.commands.perform import clear, let_be
from rig.commands.show.outlet import Here
from rig.commands.show.show import Show
from rig.core.errors import NotReady
from rig.process.interrupts import Interrupts
from rig.session import Session
from rig.supervisor import State
from tests.drivers.virtual import wired


@pytest.mark.long
def test_a_fault_is_said_cleared_and_said_to_be_cleared(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rig = wired()
    rig.twin.drive.fault(0x3210)
    rig.wire.wait_until(rig.wire.now() + 0.01)
    monkeypatch.setattr(type(rig.bench), "open", lambda bench, clock: rig.instruments)
    said = io.StringIO()
    with Session(rig.bench, "virtual", tmp_path, Interrupts()) as session:
        let_be(session, Show(Here("lines", said)))
        assert session.supervisor.state is State.FAULT
        clear(session, Show(Here("lines", said)))
        assert session.supervisor.state is State.CONNECTED
    assert "is in fault: " in said.getvalue()
    assert "3210h, voltage" in said.getvalue()
    assert "every check is made anew" in said.getvalue()


def test_a_fault_that_stays_ends_the_verb_before_anything_moves(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rig = wired()
    rig.twin.drive.fault(0x2310)
    rig.twin.drive.incurable = True
    rig.wire.wait_until(rig.wire.now() + 0.01)
    monkeypatch.setattr(type(rig.bench), "open", lambda bench, clock: rig.instruments)
    with Session(rig.bench, "virtual", tmp_path, Interrupts()) as session:
        with pytest.raises(NotReady, match="stays in fault after a reset"):
            clear(session, Show(Here("lines", io.StringIO())))
        assert session.supervisor.state is State.FAULT
    assert list(tmp_path.iterdir()) == []


def test_only_the_option_asks_for_it() -> None:
    parser = argparse.ArgumentParser()
    run.arguments(parser)
    assert parser.parse_args(["standstill"]).before is let_be
    assert parser.parse_args(["standstill", "--reset"]).before is clear
