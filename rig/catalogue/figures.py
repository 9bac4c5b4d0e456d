"""The figures of one run, from its result.json, by the words people use for them."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rig.catalogue.remembered import Remembered
from rig.catalogue.row import number, text
from rig.core.errors import UsageError
from rig.core.nearest import nearest
from rig.runfile.manifest import contents

NAME = "result.json"
NAN = math.nan
REJECTED = "Rejected run."  # began how a figure that does not count was found, before result.json had `counts`

WORDS: dict[str, tuple[str, ...]] = {  # what people say → the estimates it stands for
    "peak-to-peak": ("kinematic_error_peak_to_peak",),
    "C_2": ("fourier_amplitude_2",),
    "K1": ("stiffness_K1",),
    "hysteresis-loss": ("hysteresis_loss",),
    "friction": ("coulomb", "coulomb_torque"),  # of a friction run, of a coast-down: series of their own
}


@dataclass(frozen=True, slots=True)
class Figure:
    """One estimate as result.json has it. NaN where a number is absent."""

    name: str
    label: str
    value: float
    unit: str
    low: float  # of the 95 % interval
    high: float
    rejected: bool = False  # it does not count

    @property
    def half(self) -> float:
        """Half of the interval's width; NaN without one."""
        return (self.high - self.low) / 2


def common_label(found: Iterable[Figure]) -> str:
    """What one figure of several runs is called: without the speed it was measured at, where they differ in it."""
    labels = list(dict.fromkeys(figure.label for figure in found))
    return labels[0] if len(labels) == 1 else re.sub(r" at [\d.]+ rpm", "", labels[0])


def names_of(word: str) -> tuple[str, ...]:
    """The estimates a word stands for; the name of an estimate stands for itself."""
    known = {name.lower().replace("_", "-"): names for name, names in WORDS.items()}
    return known.get(word.lower().replace("_", "-"), (word,))


def bare(root: Path | str, folders: Sequence[Path], of: int) -> str:
    """Says of the runs in `folders`, `of` so many, which have no figures, why, and what to do; "" of none."""
    waiting = sum(1 for folder in folders if not (folder / NAME).exists())
    said = []
    if waiting:
        verb, whose = ("is", "its") if waiting == 1 else ("are", "their")
        said.append(f"{waiting} of {of} {verb} not analysed yet: `hdrig analyse {root}` makes {whose} figures")
    if none := len(folders) - waiting:
        verb, has, whose = ("was", "has", "its") if none == 1 else ("were", "have", "their")
        said.append(f"{none} of {of} {verb} analysed and {has} no figures: {whose} {NAME} says why")
    return "; ".join(said)


def refuse_unknown(word: str, seen: set[str], bare: str) -> None:
    """Raises UsageError for a figure that is in none of the runs looked at, which have those `seen`; `bare` says which
    of them have none at all, "" where each has some."""
    if seen & set(names_of(word)):
        return
    if bare and not seen and names_of(word) != (word,):  # nothing is wrong with the word
        raise UsageError(f"none of the runs has a figure '{word}'; {bare}")
    words = {said for said in WORDS if not seen or seen & set(names_of(said))}  # none that no run can answer
    others = {*words, *seen} - {word}
    more = f"; {bare}" if bare else ""
    raise UsageError(f"none of the runs has a figure '{word}'; {nearest(word, others)}{more}")


def figures(folder: Path) -> Mapping[str, Figure]:
    """Every figure of a run by its name; none where it was not analysed. Raises UsageError for a damaged file."""
    found, problem = _read(f"{folder}/{NAME}")
    if problem:
        raise UsageError(problem)
    return found


def _fresh(path: str) -> tuple[dict[str, Figure], str]:
    try:
        said = json.loads(contents(Path(path)))  # of all in it, tables included, only numbers and words are kept
    except FileNotFoundError:
        return {}, ""
    except OSError as error:
        return {}, f"{path} cannot be read: {error.strerror}"
    except (ValueError, RecursionError) as error:
        return {}, f"{path} is not JSON: {error}"
    estimates = said.get("estimates", {}) if isinstance(said, dict) else None
    if not isinstance(estimates, dict):
        return {}, f"{path} holds no estimates by name"
    return {name: _figure(name, e) for name, e in estimates.items() if isinstance(e, dict)}, ""


def _figure(name: str, e: Mapping[str, Any]) -> Figure:
    interval = e.get("ci95")
    ends = [_or_nan(x) for x in interval] if isinstance(interval, list) and len(interval) == 2 else [NAN, NAN]
    return Figure(
        name, text(e.get("label")) or name, _or_nan(e.get("value")), text(e.get("unit")), ends[0], ends[1],
        not (counts if isinstance(counts := e.get("counts"), bool) else not text(e.get("how")).startswith(REJECTED)),
    )  # fmt: skip


def _or_nan(value: object) -> float:
    found = number(value)
    return NAN if found is None else found


_read = Remembered(_fresh)
