"""Why an effect that removes most of an excess by itself is not named: what stays beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rig.analysis.tracing.answer import Candidate, Status, Verdict
from rig.analysis.tracing.fit.channels import SENSOR_NAMES
from rig.analysis.tracing.outcome.result import Errors
from rig.analysis.tracing.thresholds import EXPLAINED
from rig.core.units import ARCSEC


def dismissed(found: Sequence[Candidate], verdict: Verdict, pooled: Errors) -> tuple[Candidate, ...]:
    """`found`, with what stays above its floor (`pooled`) beside a candidate that nothing else was preferred to, or
    what else speaks against it."""
    named = {*verdict.effects, *verdict.rivals}
    return tuple(c if named else _with_the_rest(c, verdict, pooled) for c in found)


def _with_the_rest(c: Candidate, verdict: Verdict, pooled: Errors) -> Candidate:
    floors = {
        "theta_l": pooled.floor_kinematic_error_arcsec and pooled.floor_kinematic_error_arcsec * ARCSEC,
        "tau_m": pooled.floor_tau_m,
        "tau_l": pooled.floor_tau_l,
    }
    ratios = {s: c.heldout_rms[s] / floor for s, floor in floors.items() if floor and s in c.heldout_rms}
    loud = [f"the {SENSOR_NAMES[s]} at {ratio:.1f}" for s, ratio in ratios.items() if ratio > EXPLAINED]
    if not c.why.startswith("alone it removes") or "would be asked for" in c.why or "nothing" in c.why:
        return c
    if loud:
        return replace(c, why=f"{c.why}, but leaves {' and '.join(loud)} times its floor, so that it is not named")
    if ";" in c.why:
        return c
    against = "it does not explain all, or not as well as what the verdict tells, so that it is not named"
    if verdict.status is Status.NOTHING:
        against = "but that excess is within what repeats of a run differ by: too little to name anything by"
    return replace(c, why=f"{c.why}; {against}")
