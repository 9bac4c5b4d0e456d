"""A procedure's parameters in words: unit and meaning, as they stand beside its fields."""

from __future__ import annotations

import inspect
import re
from dataclasses import MISSING, dataclass, fields
from typing import Any

UNITS = (
    "N·m·s/rad",
    "N·m/s",
    "N·m",
    "kg·m²",
    "rad/s",
    "deg",
    "rad",
    "rpm",
    "Hz",
    "turns",
    "mm",
    "s",
    "1",
)  # longest first
SUFFIXES = {"_deg": "deg", "_rpm": "rpm", "_hz": "Hz", "_mm": "mm", "_s": "s"}
# a field of a dataclass, over several lines where it is long, and what stands beside it
COMMENT = re.compile(r"^    (\w+): (?:[^#\n]|\n(?=        |    \)))*#\s*(.+)$", re.M)


@dataclass(frozen=True)
class Told:
    """One parameter. `unit` is "" for a count, a share or a list of words; `default` None where there is none."""

    name: str
    default: Any
    unit: str
    meaning: str
    signed: bool

    @property
    def line(self) -> str:
        """ "frequency=0.01 Hz", then what it means, for --help."""
        shown = f"{self.name}={_shown(self.default)}" + (f" {self.unit}" if self.unit else "")
        return f"{shown:32s}  {self.meaning}".rstrip()

    def written(self, value: Any) -> str:
        """A value of it, with its unit."""
        return f"{_shown(value)} {self.unit}".rstrip()


def told(kind: type[Any]) -> list[Told]:
    """Every field of `kind`, a dataclass, in its order."""
    beside = dict(COMMENT.findall(inspect.getsource(kind)))
    return [_told(f, beside.get(f.name, "")) for f in fields(kind)]


def _told(field: Any, text: str) -> Told:
    default = None if field.default is MISSING else field.default
    unit = next((unit for end, unit in SUFFIXES.items() if field.name.endswith(end)), "")
    if not unit:
        unit = next((u for u in UNITS if re.match(rf"{re.escape(u)}(?![\w·/])", text)), "")
    meaning = re.sub(rf"^{re.escape(unit)}(?![\w·/])[\s,:]*", "", text) if unit else text
    return Told(field.name, default, unit, meaning, bool(field.metadata.get("signed", False)))


def _shown(default: Any) -> str:
    """As --with takes it."""
    if isinstance(default, tuple):
        return "[" + ",".join(f"{value:g}" for value in default) + "]"
    return f"{default:g}" if isinstance(default, float) else str(default)
