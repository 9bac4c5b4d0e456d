"""The estimates of a result as cards: the headline first, figures found in the same way together on one card."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby, takewhile
from typing import NamedTuple

from rig.analysis.findings.result import Estimate
from rig.report.numbers import companion, estimate
from rig.report.words import HEADLINES, definition


class Line(NamedTuple):
    """One figure: its name on the card ("" where the card has only this), value, what follows it: interval and unit."""

    name: str
    value: str
    spread: str
    also: str  # the same in the second usual unit


class Card(NamedTuple):
    """Figures that share how they were found."""

    label: str
    lines: list[Line]
    definition: str
    how: str
    void: bool = False  # of a rejected run: shown, and does not count


def in_order(estimates: Sequence[Estimate]) -> list[Estimate]:
    """The headline, then figures with an interval, then counts and spans; otherwise as they came."""
    headline = next((name for name in HEADLINES if any(e.name == name for e in estimates)), "")
    return sorted(estimates, key=lambda e: (e.name != headline, e.ci95[0] == e.ci95[1]))


def cards(estimates: Sequence[Estimate]) -> list[Card]:
    """One card for each figure, or for neighbours with the same `how` and labels that begin alike."""
    if not estimates:
        return []
    first, *others = in_order(estimates)
    out = [_card([first], headline=True)]
    for _, group in groupby(others, key=lambda e: (e.how, e.unit, e.counts)):
        alike = list(group)
        out += [_card(alike)] if _stem(alike) else [_card([e]) for e in alike]
    return out


def _stem(estimates: Sequence[Estimate]) -> str:
    """What the labels of two or more have in common, in whole words; "" when that is nothing."""
    words = zip(*(e.label.split(" ") for e in estimates), strict=False)
    return " ".join(w[0] for w in takewhile(lambda w: len(set(w)) == 1, words)) if len(estimates) > 1 else ""


def _card(estimates: Sequence[Estimate], headline: bool = False) -> Card:
    stem, (first, *_) = _stem(estimates), estimates
    lines = [_line(e, e.label[len(stem) :].strip() if stem else "", headline) for e in estimates]
    return Card(stem or first.label, lines, definition(first.name), first.how, not first.counts)


def _line(found: Estimate, name: str, headline: bool) -> Line:
    text = estimate(found.value, found.ci95, found.unit)
    mark = next((m for m in (" ± ", " (") if m in text and text[0] != "("), "")
    value, _, spread = text.partition(mark) if mark else (text, "", "")
    second = headline or found.unit != "arcsec"  # arcmin beside every arcsec would bury the figures
    return Line(name, value, mark + spread, companion(found.value, found.ci95, found.unit) if second else "")
