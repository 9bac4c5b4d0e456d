"""Fig. 9: peak to peak of the kinematic error against load."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.claim import Claim, Number, Ruling, at_most, missing, positive
from rig.analysis.reproduction.exhibit import Exhibit
from rig.analysis.reproduction.loads import by_load, drawn, points

LEVEL = 7.5  # N·m  from here the paper's curve is flat
NEAR = 0.5  # N·m  another rig's weights need not be the paper's
FLAT = 0.1  # of the fall up to there
TITLE = "Peak to peak against load"
PAPER = "The kinematic error shrinks as the load grows, and is constant beyond about 7.5 N·m."
FALLS = "It falls with load"
STEADILY = "It falls at every step of the load"
LEVELS = "It is flat above about 7.5 N·m"
NO_RUNS = "It takes slow runs of one assembly without load, at about 7.5 N·m and above."
Curve = Sequence[tuple[float, Number]]


def figure(campaign: Campaign) -> Exhibit:
    """All loads of the assembly that was run at speed."""
    here = [p for p in points(campaign) if p.assembly == campaign.assembly]
    curve = by_load(here)
    claims = (falls(curve), steadily(curve, _friction(campaign)), levels(curve))
    if len(curve) < 2:
        return Exhibit("Figure 9", TITLE, PAPER, "", claims, missing=NO_RUNS)
    how = f"{len(here)} slow runs of assembly {campaign.assembly}, {len(curve)} loads; both directions averaged."
    return Exhibit("Figure 9", TITLE, PAPER, how, claims, "loads", drawn(here))


def _friction(campaign: Campaign) -> str:
    """Why a small load need not count: friction of the load side bends the gear either way without it."""
    F_cl = None if campaign.model is None else campaign.model.parameters.get("F_cl")
    if F_cl is None or F_cl.origin != "measured":
        return ""
    return (
        f" Friction of the load side, {F_cl.value:.2f} N·m, loads the gear both ways before any weight hangs on it: up "
        "to there a weight takes off one way what it adds the other."
    )


def at(curve: Curve, load: float) -> Number | None:
    """The number at about `load`."""
    return next((number for x, number in curve if abs(x - load) <= NEAR), None)


def falls(curve: Curve) -> Claim:
    """From no load to 7.5 N·m."""
    first, level = (curve[0][1] if curve and curve[0][0] == 0.0 else None), at(curve, LEVEL)
    if first is None or level is None:
        return missing(FALLS, NO_RUNS)
    rule = "Peak to peak without load less that at 7.5 N·m, above zero with its 95 % interval."
    return Claim(FALLS, positive(first.minus(level)), "{} without load, {} at 7.5 N·m.", (first, level), rule)


def steadily(curve: Curve, friction: str) -> Claim:
    """The largest rise from one load to the next, up to 7.5 N·m."""
    rises = [(b.minus(a), x, y) for (x, a), (y, b) in pairwise(curve) if y <= LEVEL + NEAR]
    if not rises or at(curve, LEVEL) is None:
        return missing(STEADILY, NO_RUNS)
    rise, low, high = max(rises, key=lambda r: r[0].value)
    rule = "The largest change from one load to the next up to 7.5 N·m: at most zero with its 95 % interval."
    ruling = at_most(rise, 0.0)
    why = " The interval holds zero: a rise there is not told from a fall." if ruling is Ruling.OPEN else ""
    told = f"The least fall or largest rise, from {low:g} to {high:g} N·m, is a change by {{}}.{why}"
    return Claim(STEADILY, ruling, told + (friction if rise.value > 0 else ""), (rise,), rule)


def levels(curve: Curve) -> Claim:
    """What it still changes from 7.5 N·m to the largest load, against the fall before."""
    first, level = (curve[0][1] if curve and curve[0][0] == 0.0 else None), at(curve, LEVEL)
    if first is None or level is None or curve[-1][0] <= LEVEL + NEAR:
        return missing(LEVELS, NO_RUNS)
    last, fall = curve[-1][1], first.minus(level)
    change = level.minus(last)
    size = Number.of(abs(change.value), change.half, change.unit)
    rule = f"The change from 7.5 N·m to the largest load: at most {100 * FLAT:g} % of the fall from none to 7.5 N·m."
    told = f"From 7.5 to {curve[-1][0]:g} N·m it changes by {{}}, after a fall by {{}}."
    return Claim(LEVELS, at_most(size, FLAT * max(fall.value, 0.0)), told, (size, fall), rule)
