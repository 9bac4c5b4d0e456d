"""What is asked of a twin that runs already: its hand (weights, lock pin), its faults, how it is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rig.bench import toml_value
from rig.core.errors import UsageError
from rig.twin_hand import TwinHand

HELP = """\
at a twin that runs already, the one whose command channel is --control:
  hdrig twin free              take the lock pin out: a run that died may have left the output locked
  hdrig twin lock              fit it; refused while the output turns
  hdrig twin hang 3            hang 3 N·m on the output, positive pulls forward; hang 0 takes the weight off
  hdrig twin reassemble 0.1    wave generator out and in again, 0.1 mm from its depth
  hdrig twin status            bus, nodes, drive, output, faults that stand; truth: what really happens now, SI
  hdrig twin stop              end it
  hdrig twin heal              end every fault that was made
  hdrig twin help              all it can be asked for, faults among them; as hdrig twin sto active=true"""
HAND = {
    "free": ("unlock", ""),
    "lock": ("lock", ""),
    "hang": ("load", "tau_ext"),
    "reassemble": ("reassemble", "depth_mm"),
}

NUMBERS = {
    "tau_ext": "the torque on the output in N·m, for example 'hdrig twin hang 3'",
    "depth_mm": "the depth in mm, for example 'hdrig twin reassemble 0.1'",
}

OWN = {"tau_ext": "N·m", "depth_mm": "mm"}  # units of those numbers

UNITS = {
    **dict.fromkeys(("t", "late"), "s"),
    **dict.fromkeys(("theta_m", "theta_l", "phi"), "rad"),
    **dict.fromkeys(("omega_m", "omega_l"), "rad/s"),
    **dict.fromkeys(("tau_m", "tau_l", "tau_ext"), "N·m"),
}


def ask(control: Path, words: Sequence[str]) -> list[str]:
    """The answer, a line each. Raises UsageError: not understood; NotReady: nobody there, or the twin refuses."""
    asked, hand = understood(words), TwinHand(str(control))
    try:
        answer = hand.ask(asked, UsageError)
    except UsageError:
        there = _as_here(hand.ask({"do": "help"}))
        if asked["do"] in there or words[0] in there:
            raise
        raise UsageError(
            f"a twin cannot be asked for '{words[0]}'; expected one of {', '.join(sorted(there))}"
        ) from None
    if asked["do"] == "help":
        answer = _as_here(answer)
    answer.pop("ok", None)
    done = f"SIMULATED: the twin at {control}: {' '.join([*words, *_unit(words, asked)])}"
    return [done, *(f"  {key:14s} {told(key, value)}" for key, value in answer.items())]


def _unit(words: Sequence[str], asked: dict[str, Any]) -> list[str]:
    """Of a number that was given without its key."""
    own = HAND.get(words[0], ("", ""))[1]
    return [OWN[own]] if own in asked and len(words) == 2 and "=" not in words[1] else []


def _as_here(answer: dict[str, Any]) -> dict[str, Any]:
    """What a twin can be asked for, by the words that are used here."""
    here = {name: verb for verb, (name, _) in HAND.items()}
    return {here.get(key, key): value for key, value in answer.items() if key != "ok"}


def told(key: str, value: Any) -> str:
    """One value of an answer for a person, with its unit; an error code as manuals write it, 8130h."""
    if key == "error_code" and isinstance(value, int):
        return f"{value:04X}h" if value else "none"
    if key == "faults" and isinstance(value, list):
        return "; ".join(map(str, value)) or "none put in"
    if key == "load" and isinstance(value, float):
        return f"{100 * value:.1f} % of the bus"
    if isinstance(value, list):
        return ", ".join(map(str, value)) or "none"
    return f"{value:.6g} {UNITS[key]}" if key in UNITS and isinstance(value, float) else str(value)


def understood(words: Sequence[str]) -> dict[str, Any]:
    """`hang 3`, or `VERB KEY=VALUE …` with values as TOML writes them. Raises UsageError."""
    verb, *rest = words
    name, own = HAND.get(verb, (verb, ""))
    out: dict[str, Any] = {"do": name}
    for word in rest:
        key, equals, value = word.partition("=")
        if not equals:
            key, value = own, word
        if not key or key in out:
            raise UsageError(f"hdrig twin {' '.join(words)}: '{word}' is not understood; expected KEY=VALUE")
        out[key] = toml_value(value)
    refuse_numbers(f"hdrig twin {verb}", out)
    if own == "tau_ext" and own not in out:
        raise UsageError(f"hdrig twin {verb}: expected {NUMBERS[own]}")
    return out


def refuse_numbers(who: str, asked: dict[str, Any]) -> None:
    """Raises UsageError where what the hand is asked for is no finite number."""
    for key, expected in NUMBERS.items():
        value = asked.get(key, 0.0)
        if type(value) not in (int, float) or not abs(value) < math.inf:
            raise UsageError(f"{who}: {key} = {value} is no finite number; expected {expected}")
