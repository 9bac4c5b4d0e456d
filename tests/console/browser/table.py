"""The buttons of the page, and for every state the station can be in those that may be pressed then."""

from __future__ import annotations

from typing import Any, NamedTuple

from tests.console.browser.puppet import BENCH, RUN


class Button(NamedTuple):
    """What a finger finds, and the act that a press sends."""

    selector: str
    act: str


BUTTONS = {
    "connect": Button("[data-act=connect]", "connect"),
    "disconnect": Button("[data-act=disconnect]", "disconnect"),
    "check": Button("[data-act=check]", "check"),
    "prove": Button("[data-act=prove]", "prove"),
    "tare": Button("[data-act=tare]", "tare"),
    "jog back": Button("[data-jog='-1']", "jog"),
    "jog forward": Button("[data-jog='1']", "jog"),
    "start": Button("#start", "start"),
    "note": Button("[data-act=note]", "note"),
    "reset": Button("#reset", "reset"),
    "hold": Button("#hold", "hold"),
    "stop": Button("#stop", "stop"),
    "halt": Button("#halt", "halt"),
    "take control": Button("#take-control", "take_control"),
    "it is done": Button("#prompt-done", "answer"),
    "it cannot be done": Button("#prompt-not", "answer"),
}
URGENT = {"hold", "stop", "halt"}
TURNS = {"prove", "jog back", "jog forward"}
IDLE = URGENT | TURNS | {"check", "tare", "start", "note", "disconnect"}
IN_FAULT = URGENT | {"check", "reset", "note", "disconnect"}
ANSWERS = {"it is done", "it cannot be done"}
FREE = {"tau_ext": 0.0, "output_locked": False, "depth_mm": 0.0, "assembly": 1}
AT_REST: dict[str, Any] = {
    "station": True, "bench": BENCH, "job": "", "run": None, "proof": None, "fault": "", "unsure": "", "prompt": None,
    "rigging": FREE, "campaign": None,
}  # fmt: skip
MOVING = {"job": "run kinematic-error", "run": RUN}
ASKED = {"id": "p1", "text": "fit the lock pin", "what": "LockOutput"}
SITUATIONS: dict[str, tuple[dict[str, Any], set[str]]] = {
    "disconnected": ({"state": "disconnected", "bench": None}, URGENT | {"connect", "check"}),
    "connecting": ({"state": "disconnected", "bench": None, "job": "connecting twin"}, URGENT),
    "connected": ({"state": "connected"}, IDLE),
    "being checked": ({"state": "connected", "job": "checking machine, bus and bench"}, URGENT | {"note"}),
    "ready": ({"state": "ready", "proof": "ratio 49.994"}, IDLE),
    "enabled": ({"state": "enabled", **MOVING}, URGENT | {"note"}),
    "running": ({"state": "running", **MOVING}, URGENT | {"note"}),
    "holding": ({"state": "holding", **MOVING}, URGENT | {"note"}),
    "stopping": ({"state": "stopping", **MOVING}, URGENT | {"note"}),
    "just tripped": ({"state": "fault", "fault": "no torque sample for 41 ms", **MOVING}, URGENT | {"note"}),
    "fault": ({"state": "fault", "fault": "following error 12.4 deg"}, IN_FAULT),
    "asked for a change by hand": (
        {"state": "ready", "job": "campaign quick", "prompt": ASKED},
        URGENT | ANSWERS | {"note"},
    ),
    "output locked": ({"state": "ready", "rigging": {**FREE, "output_locked": True}}, IDLE - TURNS - {"tare"}),
    "a weight hangs": ({"state": "ready", "rigging": {**FREE, "tau_ext": 5.0}}, IDLE - {"tare"}),
    "a change not shown": ({"state": "ready", "unsure": "fit the lock pin"}, IDLE - TURNS - {"tare"}),
    "no torque sensor": ({"state": "ready", "bench": {**BENCH, "torque_sensor": False}}, IDLE - {"tare"}),
}
