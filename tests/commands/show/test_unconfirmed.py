"""Where a drive did not confirm that its torque is off, the terminal says at once what to do."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from rig.commands.show.show import Show
from rig.core.errors import Exit
from rig.loop import Ending
from rig.session.log import SessionLog
from rig.supervisor import UNCONFIRMED, Act, State, Supervisor


class Heard:
    """An outlet that keeps what it gets."""

    def __init__(self) -> None:
        self.events: list[dict[str, Any]] = []

    def put(self, event: dict[str, Any]) -> None:
        self.events.append(event)


@pytest.mark.parametrize("confirmed", [True, False])
def test_a_lost_bus_tells_to_press_the_hard_wired_stop(confirmed: bool) -> None:
    heard: Any = Heard()
    reason = "CAN bus 'rig' is lost" + ("" if confirmed else f"; {UNCONFIRMED}")
    Show(heard).ended(Path("run"), Ending("tripped", reason, Exit.TRIPPED, confirmed=confirmed))
    said = [event["text"] for event in heard.events if event["event"] == "said"]
    assert [text.startswith("Press the hard-wired stop, there may be torque still") for text in said] == (
        [] if confirmed else [True]
    )
    assert heard.events[0]["reason"] == reason


@pytest.mark.parametrize("after", ["", f"; {UNCONFIRMED}"])
def test_a_trip_is_told_at_once_and_again_only_where_more_is_found_out(after: str) -> None:
    heard: Any = Heard()
    show = Show(heard)
    log = SessionLog(lambda: 1.5, show)
    supervisor = Supervisor(log.announce)
    why = "no new motor-encoder sample for 20 ms"
    log.tripped(why)  # by the loop, which now waits for the drive
    assert [(e["event"], e["text"]) for e in heard.events] == [("trip", f"fault: {why}")]
    supervisor.act(Act.TRIP, f"{why}{after}")
    supervisor.amend("; the motor turns on")
    told = [f"fault: {why}", *([f"fault: {why}{after}"] if after else []), f"fault: {why}{after}; the motor turns on"]
    assert [e["text"] for e in heard.events] == told
    supervisor.act(Act.RESET)
    supervisor.act(Act.TRIP, why)  # another time, and told by nobody before
    assert [e["text"] for e in heard.events[len(told) :]] == [str(State.CONNECTED), f"fault: {why}"]


def test_a_trip_that_was_told_in_one_run_hides_none_of_the_next() -> None:
    heard: Any = Heard()
    show = Show(heard)
    show.tripped("over-current", 0.5)
    show.event("state", "ready", None)
    show.event("trip", "fault: over-current", 0.5)
    show.event("trip", "fault: over-current", 0.7)
    assert [(e["event"], e["t"]) for e in heard.events] == [("trip", 0.5), ("state", None), ("trip", 0.7)]
