"""One case marked: what was hidden, what was said."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tests.blind.parameters import Compared, compare

WORTH_A_NAME = 1.5  # times the floor: below, silence is no mistake
NO_ANSWER = "no answer"


@dataclass(frozen=True)
class Mark:
    """Truth and answer of one case. `before`, `after`: worst channel's held-out error over floor; None: not told."""

    case: str
    kind: str
    plan: str
    hidden: tuple[str, ...]  # "effect/form" of the main ones
    expected: tuple[str, ...]  # names of the library that are to be said
    present: frozenset[str]  # the small ones too: no mistake to say them
    size: float
    smallest: float
    status: str
    names: tuple[str, ...]
    rivals: tuple[str, ...]
    coordinate: str | None
    coordinates: tuple[str, ...]
    before: float | None
    after: float | None
    compared: tuple[Compared, ...]
    seconds: float

    @property
    def first_right(self) -> bool:
        return bool(self.names) and self.names[0] in self.expected

    @property
    def exact(self) -> bool:
        return set(self.names) == set(self.expected)

    @property
    def wrong(self) -> tuple[str, ...]:
        return tuple(name for name in self.names if name not in self.present)

    @property
    def refused(self) -> bool:
        return self.status == "unknown_effect" and not self.names

    @property
    def handled(self) -> bool:
        """An undecidable case: the truth is among what is offered, and nothing false is claimed alone."""
        offered = {*self.names, *self.rivals}
        return self.status == "ambiguous" and bool(offered & set(self.expected))

    @property
    def decent(self) -> bool:
        """Undecidable, and yet no harm done: the truth is named or offered and nothing false is claimed."""
        return bool({*self.names, *self.rivals} & set(self.expected)) and not self.wrong

    @property
    def answer(self) -> str:
        parts = [self.status, *self.names]
        if self.rivals:
            parts.append("rivals " + ", ".join(self.rivals))
        if self.coordinate:
            parts.append(f"in {self.coordinate}")
        return " ".join(parts)


def worst_ratio(errors: Mapping[str, Any] | None) -> float | None:
    """Largest held-out error over its floor of the channels that have both; None when none has."""
    pooled = (errors or {}).get("pooled") or {}
    ratios = []
    for name, value in pooled.items():
        floor = pooled.get(f"floor_{name.replace('_rms', '')}")
        if not name.startswith("floor") and value is not None and floor:
            ratios.append(value / floor)
    return max(ratios, default=None)


def mark(case: str, truth: Mapping[str, Any], answer: Mapping[str, Any], seconds: float) -> Mark:
    """Judge one answer (trace.json) by the truth of its case; an empty answer is a case without one."""
    verdict = answer.get("verdict", {})
    main = [hidden for hidden in truth["hidden"] if hidden["role"] == "main"]
    compared = [c for hidden in main for c in compare(hidden, truth["rig"], answer)]
    return Mark(
        case=case,
        kind=truth["kind"],
        plan=truth["plan"],
        hidden=tuple(f"{hidden['effect']}/{hidden['form']}" for hidden in main),
        expected=tuple(truth["effects"]),
        present=frozenset(hidden["effect"] for hidden in truth["hidden"] if not hidden["coordinates"]),
        size=truth["size"],
        smallest=min((hidden["size_alone"] for hidden in main), default=0.0),
        status=verdict.get("status", NO_ANSWER),
        names=tuple(verdict.get("effects", ())),
        rivals=tuple(verdict.get("rivals", ())),
        coordinate=verdict.get("coordinate"),
        coordinates=tuple(main[0]["coordinates"]) if main else (),
        before=worst_ratio(answer.get("before")),
        after=worst_ratio(answer.get("after")),
        compared=tuple(compared),
        seconds=seconds,
    )
