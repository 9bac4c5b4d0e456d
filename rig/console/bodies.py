"""Which keys the body of a POST may have: a key that is mistyped is refused, never left out of what is done."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

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
TEXTS = ("bench", "clock", "procedure", "plan", "resume", "note", "text")
SHAPES: Mapping[str, tuple[Callable[[object], bool], str]] = {
    **dict.fromkeys(TEXTS, (lambda said: isinstance(said, str), "a text")),
    "overrides": (
        lambda said: isinstance(said, list) and all(isinstance(one, str) for one in said),
        "a list of texts, KEY=VALUE",
    ),
    "parameters": (lambda said: isinstance(said, dict), "a table of names and values"),
}  # what a key has to be where it is given and not null
OF_CHECK = ("procedure", "plan", "resume", "parameters", "bench")  # what is only looked at
FORWARDED = ("id", "act", *dict.fromkeys(key for keys in OF_ACT.values() for key in keys))  # to the station


def wrong_of_act(act: str, asked: Mapping[str, object]) -> str:
    """The refusal of keys that `act` does not have, or that hold what they cannot; "" where there are none."""
    return unknown(f"{act}", asked, OF_ACT[act], EVERY) or misshapen(act, asked) if act in OF_ACT else ""


def misshapen(who: str, asked: Mapping[str, object]) -> str:
    """The refusal of a key that holds another kind of thing; "" where there is none."""
    for key, (fits, expected) in SHAPES.items():
        if asked.get(key) is not None and not fits(asked[key]):
            return f"{who}: {key} is {str(asked[key])[:60]!r}; expected {expected}"
    return ""


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
