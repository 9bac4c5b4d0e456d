"""Waiting for rest between runs, where nobody sends SYNC: devices are asked, and silence is not taken for rest."""

from __future__ import annotations

import pytest

from rig.changes import wait_for_rest
from rig.core.errors import NotReady
from tests.drivers.virtual import wired


def test_a_rig_over_a_bus_comes_to_rest_between_runs() -> None:
    w = wired()
    w.instruments.connect()
    since = w.wire.now()
    wait_for_rest(w.instruments)
    assert w.wire.now() - since < 2.0


def test_nobody_is_asked_to_the_rig_of_a_drive_that_does_not_confirm_its_stop() -> None:
    w = wired()
    w.instruments.connect()
    next(p for p in w.twin.bus.ports if p.name.startswith("node 1")).disconnect(False)
    with pytest.raises(NotReady, match="did not confirm that its torque is off: press the hard-wired stop"):
        wait_for_rest(w.instruments)


def test_a_drive_that_says_nothing_new_is_not_at_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    w = wired()
    w.instruments.connect()
    next(p for p in w.twin.bus.ports if p.name.startswith("node 1")).disconnect(False)
    monkeypatch.setattr(w.instruments.drive, "halt", lambda: True)  # it fell silent right behind its word
    with pytest.raises(NotReady, match="tells no new motor angle"):
        wait_for_rest(w.instruments)


def test_a_look_outside_of_a_run_is_fresh_each_time() -> None:
    w = wired()
    w.instruments.connect()
    first, second = w.instruments.look(), w.instruments.look()
    assert second.t > first.t
