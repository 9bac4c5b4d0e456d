"""Fig. 7: θ̃ at 310 rpm (a), the pure kinematic error (b), and what is left: what flexibility makes (c)."""

from __future__ import annotations

import math

from rig.analysis.kinematic_error.measure import KinematicError
from rig.analysis.kinematic_error.profile import phasors
from rig.analysis.orders.wave import wave
from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.claim import Claim, Number, Ruling, at_least, at_most, missing, positive
from rig.analysis.reproduction.comparison import MOST, Shown, compared, drawn, explains, model_words
from rig.analysis.reproduction.exhibit import Exhibit
from rig.analysis.reproduction.split import (
    Split,
    bending,
    peak_to_peak,
    rms,
    share,
    split_of,
    swing,
    words,
)

SPEED_RPM = 310.0
NEXT = (1.5, 2.5)  # times the slow speed: the neighbour in a search by halving
STILL = 0.02  # of the rms: what counts as no change, from the recipe for the slow speed
A = ("Figure 7 a", "θ̃ at 310 rpm, measured and by the model")
B = ("Figure 7 b", "Pure kinematic error θ̃_p")
C = ("Figure 7 c", "What flexibility adds: θ̃_s = θ̃ − θ̃_p")
PAPER_A = "The kinematic error at speed is not the pure one: it is coloured by the gear's flexibility."
PAPER_B = (
    "Turning slower and slower, the error stops changing at around 10 rpm: what is left there is the pure kinematic "
    "error, a property of the gear's geometry."
)
PAPER_C = (
    "Less the pure error, what is left is the bending of the spring: θ̃ = θ̃_p + θ̃_s. The model has the same curves."
)
COLOURED = "θ̃ at 310 rpm is larger than θ̃_p"
SLOW = "Around 10 rpm turning slower no longer changes it"
SUM = "θ̃ = θ̃_p + θ̃_s"
MODEL = "The model’s θ̃_s is the measured one"
NO_RUN = f"It takes an unloaded run at {SPEED_RPM:g} rpm and a slow one of the same assembly."


def figure_a(campaign: Campaign) -> Exhibit:
    """θ̃, measured beside simulated."""
    split = split_of(campaign, SPEED_RPM)
    if split is None:
        return Exhibit(*A, PAPER_A, "", (missing(COLOURED, NO_RUN),), missing=NO_RUN)
    pure = campaign.pure()
    assert pure is not None
    claims = (larger(peak_to_peak(split.fast), peak_to_peak(pure[1])),)
    how = f"{words(split.reading, split.fast)}. {model_words(campaign, split)}"
    return Exhibit(*A, PAPER_A, how, claims, "compared", compared(split, Shown.TOTAL))


def larger(total: Number, pure: Number) -> Claim:
    """Peak to peak of both."""
    more = total.minus(pure)
    rule = "Peak to peak of θ̃ less that of θ̃_p, above zero with its 95 % interval."
    return Claim(COLOURED, positive(more), "Peak to peak {} at speed, {} slowly.", (total, pure), rule)


def figure_b(campaign: Campaign) -> Exhibit:
    """θ̃_p, and whether it still depends on the speed."""
    pure = campaign.pure()
    if pure is None:
        lacking = "It takes a slow run without load."
        return Exhibit(*B, PAPER_B, "", (missing(SLOW, lacking),), missing=lacking)
    reading, error = pure
    how = f"{words(reading, error)}, {peak_to_peak(error).value:.1f} arcsec peak to peak, both directions averaged."
    others = [k for r, k in campaign.slow(reading.assembly) if r.tau_ext == 0.0]
    return Exhibit(
        *B, PAPER_B, how, (settled(error, others),), "compared", drawn(phasors(error.profile, error.profile.terms))
    )


def settled(error: KinematicError, others: list[KinematicError]) -> Claim:
    """The rms by which θ̃ at about double the speed differs, as a share of θ̃_p's own."""
    here = [k for k in others if NEXT[0] <= k.speed_rpm / error.speed_rpm <= NEXT[1]]
    if not here:
        return missing(SLOW, f"No unloaded run about twice as fast as {error.speed_rpm:.1f} rpm counts here.")
    other = min(here, key=lambda k: abs(k.speed_rpm / error.speed_rpm - 2.0))
    k = min(error.profile.terms, other.profile.terms)
    a, b = error.profile, other.profile
    u = (0.5 * sum(x[:k] ** 2 for p in (a, b) for x in (p.u_cosine, p.u_sine))) ** 0.5
    change = share(phasors(b, k) - phasors(a, k), phasors(a, k), u, max(a.factor, b.factor))
    percent = Number(100 * change.value, 100 * change.low, 100 * change.high, "%")
    rule = f"rms of the difference of the two profiles over the rms of θ̃_p: at most {100 * STILL:g} %."
    told = f"From {other.speed_rpm:.1f} down to {error.speed_rpm:.1f} rpm the profile changes by {{}} of its rms."
    return Claim(SLOW, at_most(percent, 100 * STILL), told, (percent,), rule)


def figure_c(campaign: Campaign) -> Exhibit:
    """θ̃_s as the difference, as the torque sensor shows it, and of the model."""
    split = split_of(campaign, SPEED_RPM)
    if split is None:
        return Exhibit(*C, PAPER_C, "", (missing(SUM, NO_RUN), missing(MODEL, NO_RUN)), missing=NO_RUN)
    parts = split.decomposition
    size = swing(parts.flexible, parts.u, parts.factor)
    curves = compared(split, Shown.FLEXIBLE)
    shaft, model = split.reading.shaft, campaign.model
    if shaft is not None and model is not None:
        curves["turn.sensor"] = wave(bending(shaft, model, split.fast, split.total.size))
    how = (
        f"{split.reading.name} less the slow run, angle on angle: {size.value:.1f} arcsec peak to peak "
        f"({size.low:.1f} to {size.high:.1f}). {parts.alignment.sentence}"
    )
    return Exhibit(*C, PAPER_C, how, (adds_up(campaign, split), explained(split, MODEL)), "compared", curves)


def adds_up(campaign: Campaign, split: Split) -> Claim:
    """θ̃ against θ̃_p of the slow run and the bending that the torque sensor shows: three measurements, one equation."""
    shaft, model, parts = split.reading.shaft, campaign.model, split.decomposition
    if shaft is None or model is None:
        return missing(SUM, "θ̃_s apart from θ̃ takes a shaft torque and a stiffness; without them it is a definition.")
    bend = bending(shaft, model, split.fast, split.total.size)
    rest = parts.total - parts.pure - bend
    left, percent = rms(rest, parts.u, parts.factor), explains(rest, split)
    told = "Torque sensor and K account for {} of the mean square of θ̃ − θ̃_p; {} rms are left."
    rule = (
        f"θ̃ by the encoders at 310 rpm, θ̃_p by a slow run, θ̃_s by the torque sensor over K + jnΩ·B_sp, K = "
        f"{model.gear.K:.0f} N·m/rad. At least {MOST:g} % of the mean square of θ̃ − θ̃_p, with its 95 % interval."
    )
    return Claim(SUM, at_least(percent, MOST), told, (percent, left), rule)


def explained(split: Split, paper: str) -> Claim:
    """What the model leaves, as a share of what the pure error alone leaves."""
    if split.left is None:
        return missing(paper, "No model could be identified from this campaign, or it does not turn steadily.")
    percent, left = explains(split.left, split), split.rms_left()
    assert left is not None
    told = "The model accounts for {} of the mean square of θ̃ − θ̃_p; {} rms are left."
    rule = f"At least {MOST:g} % of the mean square of what speed adds, with its 95 % interval."
    ruling = at_least(percent, MOST)
    why = _why_open(percent, left) if ruling is Ruling.OPEN else ""
    return Claim(paper, ruling, told + why, (percent, left), rule)


def _why_open(percent: Number, left: Number) -> str:
    """Little is added at a low speed, so that little left is a large share of it."""
    rest = 1.0 - percent.value / 100.0
    if not (rest > 0.0 and math.isfinite(left.value)):
        return ""
    return (
        f" The interval reaches over the {MOST:g} % that are asked for: speed adds {left.value / math.sqrt(rest):.1f} "
        "arcsec rms here, and what is left is a large share of so little. More revolutions at this speed narrow it."
    )
