"""What may be asked of the station now, act by act: True, or the sentence that says why not. And what to do next."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rig.supervisor import UNCONFIRMED

ALWAYS = ("hold", "stop", "halt")  # in any state, on any revision, any number of times
ACTS = (
    *ALWAYS, "connect", "disconnect", "check", "prove", "tare", "start", "campaign", "reset", "jog", "note", "answer",
)  # fmt: skip
Allowed = dict[str, bool | str]


def allowed(picture: Mapping[str, Any]) -> Allowed:
    """For every act True or why not, from the station's own picture of itself."""
    return {act: why_not(act, picture) or True for act in ACTS}


def why_not(act: str, picture: Mapping[str, Any]) -> str:
    """Why `act` cannot be done now, one sentence; "" when it can."""
    match act:
        case "hold" | "stop" | "halt":
            return ""
        case "connect":
            return _busy(picture) or ("" if picture["bench"] is None else "a bench is connected: disconnect it first")
        case "check":
            return _busy(picture)
        case "note":
            return _unconnected(picture)
        case "answer":
            return "" if picture["prompt"] else "nothing is being asked"
        case "disconnect":
            return _busy(picture) or _unconnected(picture)
        case "reset":
            return _busy(picture) or _unconnected(picture) or _no_fault(picture)
        case "prove" | "jog":
            return _idle(picture) or _unsure(picture) or _locked(picture)
        case "tare":
            return _idle(picture) or _unsure(picture) or _untarable(picture)
        case "start" | "campaign":
            return _idle(picture)
        case _:
            return f"there is no act '{act}'; expected one of {', '.join(ACTS)}"


def advice(picture: Mapping[str, Any]) -> str:
    """What to do next, one sentence."""
    if picture["prompt"]:
        return f"By hand: {picture['prompt']['text']}; then say that it is done."
    if picture["state"] == "holding":
        return "Held, torque on. The run does not go on from here: stop takes the torque off gently, halt at once."
    if picture["job"] and picture["state"] == "fault":
        return "Torque off is commanded and is being confirmed: stay clear of the rig."
    if picture["job"]:
        return f"{picture['job'][0].upper()}{picture['job'][1:]}: hold, stop and halt work at any moment."
    if picture["bench"] is None:
        return "Choose a bench and connect it; nothing is energised by that."
    if picture["state"] == "fault" and UNCONFIRMED in picture["fault"]:
        return (
            "Press the hard-wired stop: there may be torque still. When the rig is whole, free to turn, and the drive "
            "answers again, reset the fault; where that is refused, disconnect, connect and reset it then."
        )
    if picture["state"] == "fault":
        return "Look at the rig: when it is whole and free to turn, reset the fault. The proof is made anew after it."
    if _unsure(picture):
        return "A change by hand was not shown: the next run or campaign first asks for weight and pin to come off."
    if picture["proof"] is None:
        return "Make the sign-and-scale proof, one turn forth and back; or start a run, which makes it first."
    return "Ready: choose a procedure or a campaign and start it."


def _busy(picture: Mapping[str, Any]) -> str:
    return f"busy: {picture['job']}" if picture["job"] else ""


def _unconnected(picture: Mapping[str, Any]) -> str:
    return "no bench is connected" if picture["bench"] is None else ""


def _no_fault(picture: Mapping[str, Any]) -> str:
    return "" if picture["state"] == "fault" else "nothing is in fault"


def _idle(picture: Mapping[str, Any]) -> str:
    fault = f"the rig is in fault: {picture['fault']}" if picture["state"] == "fault" else ""
    return _busy(picture) or _unconnected(picture) or fault


def _locked(picture: Mapping[str, Any]) -> str:
    return "the output is locked" if picture["rigging"]["output_locked"] else ""


def _untarable(picture: Mapping[str, Any]) -> str:
    if not picture["bench"]["torque_sensor"]:
        return "the bench has no torque sensor"
    hung = picture["rigging"]["tau_ext"]
    return f"{hung:+g} N·m hang on the output: the torque sensor is tared without" if hung else _locked(picture)


def _unsure(picture: Mapping[str, Any]) -> str:
    what = picture["unsure"]
    return f"what the rig is like is not known: '{what}' was asked for and could not be shown" if what else ""
