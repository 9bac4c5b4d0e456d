"""What may be asked in which state, as a table."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from rig.station.rules import ACTS, ALWAYS, advice, allowed
from rig.station.status import Status
from rig.supervisor import UNCONFIRMED

BENCH: dict[str, Any] = {"name": "twin", "torque_sensor": True}
FREE = {"tau_ext": 0.0, "output_locked": False, "depth_mm": 0.0, "assembly": 1}
ON = Status(bench=BENCH, state="ready", proof="ratio 50")
PROMPT = {"id": "1", "text": "fit the lock pin", "what": "LockOutput"}
IDLE_ACTS = {"disconnect", "check", "prove", "tare", "start", "campaign", "jog", "note"}

STATES: dict[str, tuple[Status, set[str]]] = {
    "disconnected": (Status(), {"connect", "check"}),
    "connected": (replace(ON, state="connected"), IDLE_ACTS),
    "ready": (ON, IDLE_ACTS),
    "running": (replace(ON, state="running", job="run kinematic-error"), {"note"}),
    "just tripped": (replace(ON, state="fault", job="run kinematic-error", fault="shaft torque"), {"note"}),
    "asking": (replace(ON, job="campaign quick", prompt=PROMPT), {"note", "answer"}),
    "fault": (replace(ON, state="fault", fault="shaft torque"), {"disconnect", "check", "reset", "note"}),
    "locked": (replace(ON, rigging={**FREE, "output_locked": True}), IDLE_ACTS - {"prove", "tare", "jog"}),
    "loaded": (replace(ON, rigging={**FREE, "tau_ext": 5.0}), IDLE_ACTS - {"tare"}),
    "unsure": (replace(ON, unsure="fit the lock pin"), IDLE_ACTS - {"prove", "tare", "jog"}),
    "no sensor": (replace(ON, bench={**BENCH, "torque_sensor": False}), IDLE_ACTS - {"tare"}),
}


@pytest.mark.parametrize("name", STATES)
def test_exactly_these_acts_are_allowed(name: str) -> None:
    status, wanted = STATES[name]
    found = allowed(status.picture())
    assert {act for act, why in found.items() if why is True} == wanted | set(ALWAYS)


@pytest.mark.parametrize("name", STATES)
def test_whatever_is_not_allowed_says_why_in_a_sentence(name: str) -> None:
    found = allowed(STATES[name][0].picture())
    assert set(found) == set(ACTS)
    assert all(why is True or (isinstance(why, str) and len(why) > 8) for why in found.values())


@pytest.mark.parametrize("name", STATES)
def test_there_is_always_something_to_do_next(name: str) -> None:
    assert advice(STATES[name][0].picture()).endswith(".")


def test_a_prompt_goes_before_everything_else_one_could_advise() -> None:
    assert "fit the lock pin" in advice(STATES["asking"][0].picture())


def test_a_trip_that_is_still_being_confirmed_promises_no_gentle_end() -> None:
    assert advice(STATES["just tripped"][0].picture()) == (
        "Torque off is commanded and is being confirmed: stay clear of the rig."
    )


def test_a_torque_nobody_confirmed_to_be_off_is_answered_by_the_hard_wired_stop() -> None:
    status = replace(STATES["fault"][0], fault=f"CAN bus 'rig' is lost; {UNCONFIRMED}")
    assert advice(status.picture()).startswith("Press the hard-wired stop")
    assert "hard-wired stop" not in advice(STATES["fault"][0].picture())


def test_who_holds_a_run_is_told_that_it_does_not_go_on_from_there() -> None:
    status = replace(ON, state="holding", job="run kinematic-error")
    assert "does not go on from here" in advice(status.picture())
