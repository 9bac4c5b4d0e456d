"""Fig. 13: torque against wind-up of the locked gear; the stiffness K of Table 1."""

from __future__ import annotations

from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.claim import Claim, Number, covers, missing, positive
from rig.analysis.reproduction.exhibit import Exhibit

K = 7160.0  # N·m/rad      [ghorbel2001, Table 1]
TITLE = "Torque against wind-up, output locked"
PAPER = (
    "The stiffness curve is soft near zero and hardens with torque; the model has one slope for it, K = 7160 N·m/rad."
)
HARDENS = "Soft near zero, hardening"
SLOPE = "K = 7160 N·m/rad"
NO_RUN = "It takes a lock test with a torque sensor."


def figure(campaign: Campaign) -> Exhibit:
    """The loop with its fitted lines."""
    reading = campaign.lock()
    if reading is None or reading.lock is None:
        return Exhibit(
            "Figure 13", TITLE, PAPER, "", (missing(HARDENS, NO_RUN), missing(SLOPE, NO_RUN)), missing=NO_RUN
        )
    found = {e.name: Number(e.value, *e.ci95, e.unit) for e in reading.lock.estimates}
    curves = {name: c for name, c in reading.lock.curves.items() if name.startswith("lock.")}
    how = f"{reading.name}. {reading.lock.sentence}"
    return Exhibit("Figure 13", TITLE, PAPER, how, (hardens(found), slope(found)), "lock", curves)


def hardens(found: dict[str, Number]) -> Claim:
    """K3 against K1."""
    first, last = found.get("stiffness_K1"), found.get("stiffness_K3")
    if first is None or last is None:
        return missing(HARDENS, "The lock test gave no piecewise lines.")
    rule = "Slope of the outer line less that of the inner one, above zero with its 95 % interval."
    return Claim(HARDENS, positive(last.minus(first)), "{} near zero, {} in the outer zone.", (first, last), rule)


def slope(found: dict[str, Number]) -> Claim:
    """K1: the paper's K is the small-torque slope of its own curve."""
    first = found.get("stiffness_K1")
    if first is None:
        return missing(SLOPE, "The lock test gave no piecewise lines.")
    rule = "7160 N·m/rad lies in the 95 % interval of the slope near zero. Another gear has another K."
    return Claim(SLOPE, covers(first, K), "Slope near zero {}.", (first,), rule)
