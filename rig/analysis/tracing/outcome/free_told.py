"""Why the free simulation may be further off than the equations the verdict is by, in a sentence with its numbers.

The equations read the shaft torque, and with it whatever shakes the load. The simulation is led by the motor alone:
what the load's equation leaves, noise of the gear that no model foretells, winds the gear up there and rings in its
resonance.
"""

from __future__ import annotations

import math
from typing import Any, Final

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.outcome.result import Errors, Trace
from rig.analysis.tracing.thresholds import EXPLAINED
from rig.model.linear import held_frequency

MOST: Final = 0.5  # of the excess over the floor, as squares


def over_floor(after: Errors) -> float | None:
    """The free simulation's error over the floor of the equations; None where either is not known."""
    error, floor = after.free_kinematic_error_rms_arcsec, after.floor_kinematic_error_arcsec
    return error / floor if error is not None and floor else None


def free_told(trace: Trace) -> dict[str, Any]:
    """For trace.json and the page: `resonance_hz` of the gear with the motor led, None where nothing was simulated, and
    `sentence`, "" where the simulation is at the floor."""
    simulated = [e for e in trace.after.per_run.values() if over_floor(e) is not None]
    if not simulated:
        return {"resonance_hz": None, "sentence": ""}
    hertz = _resonance(trace)
    loud = [e for e in simulated if (over_floor(e) or 0.0) > EXPLAINED]
    return {"resonance_hz": hertz, "sentence": _sentence(trace, loud, hertz) if loud else ""}


def _resonance(trace: Trace) -> float | None:
    """Hz; the motor is led, so that its inertia is none of it."""
    p = {q.name: q.value for q in trace.baseline_after}
    if p.get("K", 0.0) <= 0 or p.get("J_l", 0.0) <= 0:
        return None
    return held_frequency(p["K"], p["J_l"]) / (2 * math.pi)


def _sentence(trace: Trace, loud: list[Errors], hertz: float | None) -> str:
    ratios = [over_floor(e) or 0.0 for e in loud]
    said = f"The free simulation stays at {_span(ratios)} times the floor."
    if trace.verdict.status in (Status.EXPLAINED, Status.NOTHING):
        said += " That does not speak against the verdict, which is by the equations."
    rings = f"what it is not told rings on in the gear’s resonance{f' at {hertz:.3g} Hz' if hertz else ''}"
    known = [e for e in loud if e.free_by_load_rest_rms_arcsec is not None and e.tau_l_rms is not None]
    if len(known) < len(loud):
        return (
            f"{said} The equations are given what was measured of the load; the simulation is not, and {rings}. How "
            "much of it is noise of the gear, no torque sensor says."
        )
    said += (
        " The equations read the shaft torque, and with it what shakes the load; the simulation reads nothing of the "
        f"load, and {rings}"
    )
    made = [e.free_by_load_rest_rms_arcsec or 0.0 for e in known]
    torques = [1e3 * (e.tau_l_rms or 0.0) for e in known]
    said += f": the {_span(torques)} mN·m RMS that the shaft torque’s equation leaves make {_span(made)} arcsec there"
    if all((e.free_by_load_rest_rms_arcsec or 0.0) >= (e.free_kinematic_error_rms_arcsec or 0.0) for e in known):
        return f"{said} by themselves, noise of the sensor included, which is no less than what is seen."
    if all(_most_of_it(e) for e in known):
        return f"{said} by themselves, most of what is above the floor."
    return (
        f"{said} by themselves. What is more than that are errors of the model, which build up in the same way: the "
        "free simulation is the harder test, and here it is not passed."
    )


def _most_of_it(e: Errors) -> bool:
    made, error = e.free_by_load_rest_rms_arcsec or 0.0, e.free_kinematic_error_rms_arcsec or 0.0
    return bool(made**2 >= MOST * (error**2 - (e.floor_kinematic_error_arcsec or 0.0) ** 2))


def _span(x: list[float]) -> str:
    low, high = f"{min(x):.2g}", f"{max(x):.2g}"
    return low if low == high else f"{low} to {high}"
