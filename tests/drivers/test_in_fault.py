"""A rig that is connected in fault: said in words, nothing runs, an explicit reset leaves it, or it stays."""

from __future__ import annotations

from pathlib import Path

import pytest

from rig.core.errors import NotReady
from rig.procedures.kinematic_error import KinematicError
from rig.process.interrupts import Interrupts
from rig.session import Session
from rig.supervisor import Act, State
from sim.wire.odrive import Error
from sim.wire.states402 import DriveState
from tests.drivers.virtual import Driven, Wired, odriven, wired


def session(w: Wired | Driven, root: Path, monkeypatch: pytest.MonkeyPatch) -> Session:
    monkeypatch.setattr(type(w.bench), "open", lambda bench, clock: w.instruments)
    return Session(w.bench, "virtual", root, Interrupts())


def test_a_drive_in_fault_is_said_with_its_code_in_words_and_how_to_reset(tmp_path, monkeypatch):
    w = wired()
    w.twin.drive.fault(0x3210)
    w.wire.wait_until(w.wire.now() + 0.01)
    with session(w, tmp_path, monkeypatch) as rig:
        assert rig.supervisor.state is State.FAULT
        with pytest.raises(
            NotReady, match=r"is in fault: .*3210h, voltage; see that it is whole.*`hdrig reset --bench"
        ):
            rig.run(KinematicError())
        assert w.twin.drive.drive_state is DriveState.FAULT
        rig.reset()
        assert rig.supervisor.state is State.CONNECTED
        assert w.twin.drive.drive_state is DriveState.SWITCH_ON_DISABLED
    assert list(tmp_path.iterdir()) == []


def test_a_fault_that_comes_back_stays_latched(tmp_path, monkeypatch):
    w = wired()
    w.twin.drive.fault(0x2310)
    w.twin.drive.incurable = True
    w.wire.wait_until(w.wire.now() + 0.01)
    with session(w, tmp_path, monkeypatch) as rig:
        with pytest.raises(NotReady, match=r"stays in fault after a reset: .*2310h, current"):
            rig.reset()
        assert rig.supervisor.state is State.FAULT


def test_an_emergency_of_an_encoder_is_a_cause_until_it_is_looked_at_anew(tmp_path, monkeypatch):
    w = wired()
    with session(w, tmp_path, monkeypatch) as rig:
        w.twin.encoder.errors.report(0x5000, 0x80)
        w.wire.wait_until(w.wire.now() + 0.01)
        w.instruments.load_encoder.read()
        assert "emergency 5000h" in w.instruments.causes()
        rig.supervisor.act(Act.TRIP, "somebody pressed it")
        with pytest.raises(NotReady, match=r"the fault stays: .*emergency 5000h, device hardware"):
            rig.supervisor.act(Act.RESET)
        rig.reset()
        assert rig.supervisor.state is State.CONNECTED


def test_an_odrive_in_error_is_in_fault_and_is_reset(tmp_path, monkeypatch):
    w = odriven()
    w.axis.fail(Error.DC_BUS_UNDER_VOLTAGE)
    with session(w, tmp_path, monkeypatch) as rig:
        assert rig.supervisor.state is State.FAULT
        assert "DC bus under-voltage" in rig.supervisor.fault
        rig.reset()
        assert rig.supervisor.state is State.CONNECTED
