"""Table 1: the parameters of equations 5 to 7."""

from __future__ import annotations

import math

from rig.analysis.motion.declared import declared
from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.claim import Claim, Number, Ruling, covers, missing, positive
from rig.analysis.reproduction.exhibit import Cell, Exhibit
from rig.analysis.reproduction.model import Model
from rig.model.gearfile import UNITS, Parameter

TITLE = "Parameters"
PAPER = (
    "Inertias, dampings, ratio N = 50 and stiffness K = 7160 N·m/rad; a constant torque of friction was identified "
    "beside them. Of the table's numbers only N and K are readable in the text at hand."
)
SYMBOLS = {"tau_c": "τ_c"}
READABLE = {"N": 50.0, "K": 7160.0}
ROWS = ("N", "J_m", "J_l", "K", "B_m", "B_ml", "B_l", "B_sp", "tau_c", "F_cl")
FRICTION = "A constant torque of friction"
OUTSIDE = "Within “no”: the declared number lies outside; equations 5 to 7 lack what Figs. 9 and 13 show."
NO_MODEL = "It takes a gear identified from the campaign: slow, friction and lock runs with torque sensor."
COLUMNS = ("Parameter", "Identified", "Declared for this rig", "Within", "In the paper", "Origin")


def table(campaign: Campaign) -> Exhibit:
    """What was identified beside what the bench declares."""
    model = campaign.model
    if model is None:
        lacking = campaign.no_model or NO_MODEL
        return Exhibit("Table 1", TITLE, PAPER, "", (missing(FRICTION, lacking),), missing=lacking)
    said = {name: declared(campaign.readings[0].declared, name) for name in ROWS}
    rows = tuple(_row(name, p, said[name]) for name in ROWS if (p := model.parameters.get(name)) is not None)
    apart = "none of them one that Figs. 7 and 11 compare the model with" if model.held_out else "with those of Fig. 11"
    how = f"One fit to {len(model.runs)} runs, {apart}: {', '.join(model.runs)}. {_notes(model)} {OUTSIDE}"
    claims = (friction(model.parameters.get("tau_c")),)
    return Exhibit("Table 1", TITLE, PAPER, how, claims, columns=COLUMNS, rows=rows)


def _row(name: str, p: Parameter, said: float | None) -> tuple[Cell, ...]:
    unit = UNITS[name]
    number = Number(p.value, *p.interval, unit)
    return (
        SYMBOLS.get(name, name), number, _bare(said, unit), _within(number, said), _bare(READABLE.get(name), unit),
        p.origin,
    )  # fmt: skip


def _notes(model: Model) -> str:
    """What is to be known of single parameters."""
    noted = [(SYMBOLS.get(n, n), p.note) for n in ROWS if (p := model.parameters.get(n)) is not None and p.note]
    return " ".join(f"{name}: {note}." for name, note in noted)


def _bare(value: float | None, unit: str) -> Cell:
    return "" if value is None else Number(value, math.nan, math.nan, unit)


def _within(number: Number, said: float | None) -> str:
    """Whether the declared number lies in the interval of the identified one."""
    if said is None or not math.isfinite(number.half):
        return ""
    return "yes" if covers(number, said) is Ruling.HOLDS else "no"


def friction(tau_c: Parameter | None) -> Claim:
    """Coulomb friction of the motor side."""
    if tau_c is None or tau_c.origin != "measured":
        return missing(FRICTION, "Friction was not measured.")
    number = Number(tau_c.value, *tau_c.interval, "N·m")
    rule = "Coulomb friction of the motor side, above zero with its 95 % interval."
    return Claim(FRICTION, positive(number), "{} at the motor, whatever the speed.", (number,), rule)
