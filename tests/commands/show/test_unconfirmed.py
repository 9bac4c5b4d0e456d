"""Where a drive did not confirm that its torque is off, the terminal says at once what to do."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from rig.commands.show.show import Show
from rig.core.errors import Exit
from rig.loop import Ending
from rig.supervisor import UNCONFIRMED


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
