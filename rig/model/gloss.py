"""What the parameters of an effect are, in short phrases by their machine names."""

from __future__ import annotations

import re
from collections.abc import Mapping


def waved(name: str, of: str, angle: str) -> dict[str, str]:
    """Phrases of the pair that `rig.model.effect.harmonic` makes as `name`: `of` ·cos(`angle` + φ)."""
    return {f"{name}_amplitude": f"amplitude of {of}", f"{name}_phase": f"φ of {of}, in cos({angle} + φ)"}


def gloss(glosses: Mapping[str, str], name: str) -> str:
    """The phrase of the parameter `name`, "" of one that has none.

    `{n}` in a key stands for a number, and for the same one in its phrase. A number at the end of `name` that no key
    has is that of another term of the effect.
    """
    for key, phrase in glosses.items():
        wanted = re.escape(key).replace(re.escape("{n}"), r"(?P<n>[\d.]+)")
        found = re.fullmatch(rf"{wanted}(?:_(?P<again>\d+))?", name)
        if found is not None:
            text = phrase.replace("{n}", found.groupdict().get("n") or "")
            return f"{text} (another of its kind)" if found["again"] else text
    return ""
