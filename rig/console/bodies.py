"""Which keys the body of a POST may have: a key that is mistyped is refused, never left out of what is done."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from rig.core.nearest import nearest

EVERY = ("id", "act", "based_on")  # what every act says of itself
OF_ACT: Mapping[str, tuple[str, ...]] = {
    "connect": ("bench", "overrides", "clock"),
    "disconnect": (),
    "check": ("bench",),
    "prove": (),
    "tare": (),
    "start": ("procedure", "parameters", "note"),
    "campaign": ("plan", "resume", "parameters", "note"),
    "jog": ("turns", "speed_rpm"),
    "reset": (),
    "note": ("text",),
    "answer": ("prompt_id", "done"),
    "take_control": (),
}  # hold, stop and halt are not here: they are done whatever else their body says
OF_CHECK = ("procedure", "plan", "resume", "parameters", "bench")  # what is only looked at
FORWARDED = ("id", "act", *dict.fromkeys(key for keys in OF_ACT.values() for key in keys))  # to the station


def unknown_of_act(act: str, asked: Iterable[object]) -> str:
    """The refusal of keys that `act` does not have; "" where there are none."""
    return unknown(f"{act}", asked, OF_ACT[act], EVERY) if act in OF_ACT else ""


def unknown(who: str, asked: Iterable[object], known: tuple[str, ...], always: tuple[str, ...] = ()) -> str:
    """The refusal of keys that are neither `known` nor there `always`; "" where there are none."""
    wrong = next((str(key) for key in asked if key not in (*known, *always)), None)
    if wrong is None:
        return ""
    meant = nearest(wrong, known)
    hint = f" {meant}" if meant.startswith("did you mean") else ""
    known_words = ", ".join(known) if known else "none of its own"
    beside = f" (beside {', '.join(always)})" if always else ""
    return f"{who}: unknown key '{wrong[:60]}';{hint} known keys{beside}: {known_words}"
