"""Keys of a manifest that hold what they cannot mean, in words: else nobody knows why they count as not said."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from typing import Any

from rig.core.kinds import KINDS
from rig.core.nearest import nearest
from rig.core.numbers import stated

POSITIVE, NOT_NEGATIVE, ANY = "above 0", "of 0 or more", ""
NUMBERS: Mapping[str, Mapping[str, tuple[str, str]]] = {  # what it has to be, and its unit
    "conditions": {"tau_ext": (ANY, "N·m"), "speed_rpm": (ANY, "rpm"), "depth_mm": (ANY, "mm")},
    "declared": {
        "J_m": (POSITIVE, "kg·m²"),
        "J_l": (POSITIVE, "kg·m²"),
        "K": (POSITIVE, "N·m/rad"),
        "B_m": (NOT_NEGATIVE, "N·m·s/rad"),
        "B_ml": (NOT_NEGATIVE, "N·m·s/rad"),
        "B_l": (NOT_NEGATIVE, "N·m·s/rad"),
        "B_sp": (NOT_NEGATIVE, "N·m·s/rad"),
        "fourier_terms": (POSITIVE, ""),
    },
    "encoders": {"motor_counts_per_rev": (POSITIVE, "counts"), "load_counts_per_rev": (POSITIVE, "counts")},
}


def misfits(about: Mapping[str, Any]) -> list[str]:
    """One clause for every value of the manifest `about` that is none: key, value, what was expected. Keys that are
    absent or null, and such as the format does not name, are no misfits."""
    return [*_procedure(about.get("procedure")), *_locked(about), *_numbers(about)]


def _procedure(said: object) -> Iterator[str]:
    if isinstance(said, str) and said.replace("-", "_") not in KINDS:
        yield f"procedure is {_short(said)}, no kind of run there is; {nearest(said.replace('-', '_'), KINDS)}"


def _locked(about: Mapping[str, Any]) -> Iterator[str]:
    said = _table(about, "conditions").get("output_locked")
    if said is not None and not isinstance(said, bool):
        yield f"conditions.output_locked is {_short(said)}, expected true or false"


def _numbers(about: Mapping[str, Any]) -> Iterator[str]:
    for table, keys in NUMBERS.items():
        for key, (bound, unit) in keys.items():
            said = _table(about, table).get(key)
            if said is not None and not _meant(stated(said), bound):
                expected = " ".join(word for word in ("a number", bound, f"in {unit}" if unit else "") if word)
                yield f"{table}.{key} is {_short(said)}, expected {expected}"


def _meant(value: float, bound: str) -> bool:
    least = {POSITIVE: value > 0.0, NOT_NEGATIVE: value >= 0.0, ANY: True}
    return math.isfinite(value) and least[bound]


def _table(about: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    found = about.get(key)
    return found if isinstance(found, Mapping) else {}


def _short(value: object) -> str:
    """As JSON writes it; a number may have more digits than Python prints."""
    try:
        text = json.dumps(value, ensure_ascii=False)
    except (TypeError, ValueError):
        text = f"a {type(value).__name__}"
    return text if len(text) <= 60 else f"{text[:57]}..."
