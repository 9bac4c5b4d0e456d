"""Loop and creep of a lock test as a person is shown them."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.collected import Findings
from rig.analysis.stiffness.counts import of_width
from rig.analysis.stiffness.loop import rate_law
from rig.analysis.stiffness.measure import SENSOR_GAIN, Stiffness
from rig.core.units import ARCMIN


def add_loop(found: Findings, s: Stiffness) -> str:
    """Hysteresis loss, energy, and what depends on the rate; what the headline says of it."""
    if s.gap is None:
        found.cannot.append("Zero torque was not crossed on the way up and on the way down: no hysteresis loss.")
        return ""
    relative = float(np.hypot(s.tilt.zones[0], SENSOR_GAIN))
    width, half = s.gap.value / ARCMIN, float(np.hypot(s.gap.half, relative * s.gap.value)) / ARCMIN
    n = len(s.widths)
    how = (
        f"Wind-up between falling and rising ramps at zero torque, at the first rate ({n} ramps passed there at all "
        "rates). A zero error of the sensor shifts both alike and drops out. In the interval: where within a count of "
        f"the motor's encoder, {s.count / ARCMIN:.2g} arcmin, the motor stood on either branch."
    )
    found.figure("hysteresis_loss", "Hysteresis loss (gap at zero torque)", width, "arcmin", half, how)
    how = f"∮ τ dw over {s.loops} closed loops at the first rate." if s.loops else "∮ τ dw of the fitted loop."
    label, over = "Energy lost per cycle", (-s.tau_ref, s.tau_ref)
    joules = float(np.hypot(s.energy.half, relative * s.energy.value))
    found.figure("hysteresis_energy", label, s.energy.value * 1e3, "mJ", joules * 1e3, how, over=over)
    _add_rates(found, s)
    if abs(width) <= half:
        return f", hysteresis loss not told from none (below {abs(width) + half:.2g} arcmin)"
    return f", hysteresis loss {width:.2f} arcmin"


def _add_rates(found: Findings, s: Stiffness) -> None:
    law = rate_law(s.widths, 0.5 * of_width(s.count) * s.run.scale.K)  # half a width of the loop is half of the gap
    if law is None:
        found.cannot.append(
            "Viscous and hysteretic loss: the ramps have one rate; a loop that widens with the rate is viscous, one "
            "that does not is hysteresis."
        )
        return
    how = f"Half width of the loop at zero torque against rate, {len(s.widths)} ramps. {law.words()}"
    h, v = law.hysteretic, law.viscous
    found.figure("loop_hysteretic", "Half width of the loop at no rate", h.value, "N·m", h.half, how)
    found.figure("loop_viscous", "What widens it with the rate", v.value, "N·m·s/rad", v.half, how)
    found.tables["loop_against_rate"] = [
        {
            "windup_rate_arcmin/s": w.rate / ARCMIN,
            "direction": float(w.direction),
            "half_width_nm": w.half,
            "standard_uncertainty_nm": w.u,
        }
        for w in s.widths
    ]
    found.curve(
        loop__rate=np.array([w.rate / ARCMIN for w in s.widths]),
        loop__half_width=np.array([w.half for w in s.widths]),
        loop__fit=np.array([h.value, v.value * ARCMIN]),
    )


def add_creep(found: Findings, s: Stiffness) -> None:
    """Creep per decade of time at the holds."""
    c = s.creep
    if c is None:
        found.cannot.append("Creep: the torque was not held still for a second or more under load.")
        return
    how = (
        f"w − τ/K in the direction of the load against log time, {c.holds} holds of up to {c.longest:.1f} s at the "
        "ends of the ramps, allowing for what crept while they were loaded; interval from the scatter between holds."
    )
    value, half = 100 * c.per_decade.value, 100 * c.per_decade.half
    found.figure("creep_per_decade", "Creep per decade of time, share of the wind-up", value, "%", half, how)
    if c.per_decade.told and value > 0:
        found.cannot.append(
            "Hysteresis and creep: what creeps while it is wound up widens the loop too, nearly as much at any rate."
        )
    found.curve(creep__time=c.time, creep__windup=c.windup / ARCMIN * 60.0)
