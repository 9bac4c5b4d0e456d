"""Fig. 11: θ̃ at 120 (a), 300 (b) and 500 rpm (c), measured and by the model."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from rig.analysis.orders.wave import wave
from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.claim import Claim, Number, all_of, missing, positive
from rig.analysis.reproduction.comparison import Shown, compared, model_words
from rig.analysis.reproduction.exhibit import Exhibit
from rig.analysis.reproduction.figure_7 import explained
from rig.analysis.reproduction.load_effect import UnderLoad, under_load, why_worse
from rig.analysis.reproduction.split import Split, peak_to_peak, rms, split_of, words
from rig.model.linear import natural_frequency

SPEEDS = {"a": 120.0, "b": 300.0, "c": 500.0}
PAPER = {
    "a": "At 120 rpm the model follows the measurement.",
    "b": "At 300 rpm it still does; higher frequencies than at 120 rpm are in the error, in both.",
    "c": (
        "The error is larger still. Here the model is worse: the load's inertia swings the torque in the gear, and the "
        "pure error depends on the load, which the model leaves out."
    ),
}
MODEL = "The model explains what speed adds"
GROWS = "θ̃ grows with speed"
HIGHER = "Frequencies above twice the motor's speed grow with speed"
WORSE = "The model is worse at 500 rpm"
ALL = "It takes unloaded runs at 120, 300 and 500 rpm and a slow one of the same assembly."


def figures(campaign: Campaign) -> tuple[Exhibit, ...]:
    """All three; what compares speeds stands with the last."""
    splits = {part: split_of(campaign, rpm) for part, rpm in SPEEDS.items()}
    found = [s for s in splits.values() if s is not None]
    again = under_load(campaign, splits["c"])
    between = (
        grows([peak_to_peak(s.fast) for s in found], [s.fast.speed_rpm for s in found]),
        higher([_higher(s) for s in found], [s.fast.speed_rpm for s in found], _resonance(campaign, found)),
        worse([n for s in found if (n := s.rms_left()) is not None]),
        why_worse(splits["c"], again),
    )
    *slower, fastest = (_one(campaign, part, splits[part], between if part == "c" else ()) for part in SPEEDS)
    return (*slower, _with_load(fastest, splits["c"], again))


def _with_load(exhibit: Exhibit, split: Split | None, again: UnderLoad | None) -> Exhibit:
    """What the model leaves once its pure error depends on the load, below what it leaves without."""
    if split is None or again is None:
        return exhibit
    return replace(exhibit, curves={**exhibit.curves, "turn.left_loaded": wave(split.total - again.simulated)})


def _one(campaign: Campaign, part: str, split: Split | None, between: tuple[Claim, ...]) -> Exhibit:
    name, title = f"Figure 11 {part}", f"θ̃ at {SPEEDS[part]:g} rpm, measured and by the model"
    if split is None:
        lacking = f"It takes an unloaded run at {SPEEDS[part]:g} rpm and a slow one of the same assembly."
        return Exhibit(name, title, PAPER[part], "", (missing(MODEL, lacking), *between), missing=lacking)
    claims = (explained(split, MODEL), *between)
    how = f"{words(split.reading, split.fast)}. {model_words(campaign, split)}"
    return Exhibit(name, title, PAPER[part], how, claims, "compared", compared(split, Shown.TOTAL))


def _higher(split: Split) -> Number:
    """rms of orders above 2, arcsec."""
    profile = split.fast.profile
    above = np.arange(1, split.total.size + 1) > 2
    u = np.sqrt(0.5 * (profile.u_cosine**2 + profile.u_sine**2))[: split.total.size]
    return rms(split.total[above], u[above], profile.factor)


def grows(sizes: Sequence[Number], speeds: Sequence[float]) -> Claim:
    """Peak to peak, slowest first."""
    rule = "Peak to peak at each speed less that at the one before, above zero with its 95 % interval."
    return _rising(GROWS, "Peak to peak", sizes, speeds, rule)


def higher(sizes: Sequence[Number], speeds: Sequence[float], remark: str = "") -> Claim:
    """rms of what lies above order 2."""
    rule = "rms of the orders 3 to 15 at each speed less that at the one before, above zero with its 95 % interval."
    claim = _rising(HIGHER, "rms of orders 3 to 15", sizes, speeds, rule)
    return replace(claim, words=f"{claim.words} {remark}".strip()) if claim.numbers else claim


def _resonance(campaign: Campaign, splits: Sequence[Split]) -> str:
    """What the model has there, and which order meets its natural frequency."""
    if campaign.model is None or any(s.simulated is None for s in splits):
        return ""
    f_n = natural_frequency(campaign.model.gear) / (2.0 * math.pi)
    made = [float(np.sqrt(0.5 * np.sum(np.abs(s.simulated[2:]) ** 2))) for s in splits if s.simulated is not None]
    orders = [60.0 * f_n / s.fast.speed_rpm for s in splits]
    has, meets = ", ".join(f"{size:.1f}" for size in made), ", ".join(f"{n:.1f}" for n in orders)
    return (
        f"The model has {has} arcsec: its natural frequency, {f_n:.1f} Hz, is order {meets} at these speeds. Orders "
        "below it are amplified, the load no longer follows those above it: they grow with speed until they pass it "
        "and shrink from there on."
    )


def _rising(paper: str, what: str, sizes: Sequence[Number], speeds: Sequence[float], rule: str) -> Claim:
    if len(sizes) < len(SPEEDS):
        return missing(paper, ALL)
    told = f"{what}: " + ", ".join(f"{{}} at {rpm:.0f} rpm" for rpm in speeds) + "."
    return Claim(paper, all_of(*(positive(b.minus(a)) for a, b in pairwise(sizes))), told, tuple(sizes), rule)


def worse(left: Sequence[Number]) -> Claim:
    """What the model leaves at 120, 300, 500 rpm."""
    if len(left) < len(SPEEDS):
        return missing(WORSE, ALL)
    *slower, last = left
    rule = "rms of measured less model at 500 rpm less that at 120 and at 300 rpm, above zero with its 95 % interval."
    told = "The model leaves {} at 120, {} at 300, {} at 500 rpm."
    return Claim(WORSE, all_of(*(positive(last.minus(one)) for one in slower)), told, tuple(left), rule)
