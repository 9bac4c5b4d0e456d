"""Limits that a run's figures are judged against, with the guard band, and what stands in the way of a judgement."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from rig.analysis.findings.conversion import factor, others
from rig.analysis.findings.intervals import against_limit
from rig.analysis.findings.result import Check, Estimate, Verdict
from rig.core.nearest import nearest

WHERE = {
    Verdict.PASS: "the whole interval is inside",
    Verdict.FAIL: "the whole interval is outside",
    Verdict.INCONCLUSIVE: "the limit lies within the interval",
}
NO_INTERVAL = "Expected a run that repeats its motion more often, or a limit on a figure that has an interval."
SIDES = {"at least": "lower", "at most": "upper"}
GRAVEST = (Verdict.FAIL, Verdict.INCONCLUSIVE, Verdict.PASS)  # one figure out of limits fails the run


@dataclass(frozen=True)
class Judgement:
    """What the limits say of a run."""

    verdict: Verdict  # MEASURED without any limit
    checks: tuple[Check, ...] = ()
    unsettled: str = ""  # what to do about the limits that settle nothing; "" where all do
    outside: str = ""  # which figures are out of which limits; "" where none is
    limits: Mapping[str, str] = field(default_factory=dict)  # name of the figure → "Stiffness at least 7000 N·m/rad"


@dataclass(frozen=True)
class _Judged:
    verdict: Verdict
    check: Check
    limit: str  # with its figure, in words
    unsettled: str = ""


def judge(estimates: Sequence[Estimate], limits: Mapping[str, Any]) -> Judgement:
    """Every limit against its figure.

    `limits`: {estimate name: {"lower": x, "upper": y, "unit": u}} or {estimate name: upper}; without `unit` in that of
    the estimate, else converted into it (an angle in arcsec, arcmin, deg, rad or mrad); None is no limit. A limit
    without its figure, or in a unit of another quantity, is INCONCLUSIVE: what was asked about was not measured.
    """
    by_name = {e.name: e for e in estimates}
    asked = {name: limit for name, limit in limits.items() if limit is not None}
    judged = [
        _judged(name, by_name, limit if isinstance(limit, Mapping) else {"upper": limit})
        for name, limit in asked.items()
    ]
    verdicts = {j.verdict for j in judged}
    verdict = next((v for v in GRAVEST if v in verdicts), Verdict.MEASURED)
    return Judgement(
        verdict,
        tuple(j.check for j in judged),
        " ".join(j.unsettled for j in judged if j.unsettled),
        " ".join(j.check.sentence for j in judged if j.verdict is Verdict.FAIL),
        {name: j.limit for name, j in zip(asked, judged, strict=True)},
    )


def _judged(name: str, by_name: Mapping[str, Estimate], limit: Mapping[str, Any]) -> _Judged:
    e = by_name.get(name)
    given = {word: limit[key] for word, key in SIDES.items() if limit.get(key) is not None}
    if e is None:
        have = nearest(name, by_name).rstrip("?") if by_name else "it has no figure at all"
        why = f"This run has no figure '{name}' to judge against its limit; {have}."
        return _unjudged(name, why, f"{name} {_words(given, str(limit.get('unit') or '1'))}")
    if not given:
        return _unjudged(name, f"The limit of {e.label} is no number: it was not judged.", f"{e.label} by no number")
    unit = str(limit.get("unit") or e.unit)
    scale, words = factor(unit, e.unit), _words(given, unit)
    if not math.isfinite(scale):
        why = (
            f"The limit of {e.label}, {words}, is in no unit of such a figure and was not judged; expected "
            f"a number in {others(e.unit)}."
        )
        return _unjudged(name, why, f"{e.label} {words}")
    bounds = {word: bound * scale for word, bound in given.items()}
    if scale != 1.0:
        words += f" ({' and '.join(f'{bound:.6g}' for bound in bounds.values())} {e.unit})"
    low, high = e.ci95
    if not math.isfinite(high - low):
        why = f"{e.label} {e.value:.4g} {e.unit} has no interval in this run, limit {words}: no verdict can be made."
        return _unjudged(name, f"{why} {NO_INTERVAL} {e.how}", f"{e.label} {words}", why)
    verdict = against_limit(e.ci95, bounds.get("at least"), bounds.get("at most"))
    text = f"{e.label} {e.value:.4g} {e.unit} ({low:.4g} to {high:.4g}), limit {words}: {WHERE[verdict]}."
    unsettled = ""
    if verdict is Verdict.INCONCLUSIVE:
        unsettled = _to_settle(e, min(bounds.values(), key=lambda b: abs(b - e.value)))
    return _Judged(verdict, Check(f"limit_{name}", verdict is Verdict.PASS, text), f"{e.label} {words}", unsettled)


def _words(given: Mapping[str, float], unit: str) -> str:
    """ "at least 30 arcsec and at most 40 arcsec"."""
    return " and ".join(f"{word} {bound:g}{'' if unit == '1' else f' {unit}'}" for word, bound in given.items())


def _unjudged(name: str, why: str, limit: str, check: str = "") -> _Judged:
    return _Judged(Verdict.INCONCLUSIVE, Check(f"limit_{name}", False, check or why), limit, why)


def _to_settle(e: Estimate, bound: float) -> str:
    """How narrow the interval would have to be, and which part of it to reduce."""
    half, away = (e.ci95[1] - e.ci95[0]) / 2, abs(bound - e.value)
    part = max(e.parts, key=lambda p: p.half, default=None)
    largest = f"It is made so: {e.how}"
    if part is not None:
        largest = f"The most of it, ±{part.half:.2g} {e.unit}, is {part.what}: {part.remedy}."
    return (
        f"{e.label} lies {away:.2g} {e.unit} from {bound:g} {e.unit} and is known to ±{half:.2g} {e.unit}; an interval "
        f"narrower than ±{away:.2g} {e.unit} would settle it. {largest}"
    )
