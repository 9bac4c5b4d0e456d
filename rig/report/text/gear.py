"""What runs say of a gear in lines: parameters with 95 % intervals, orders of θ̃_p, θ̃ at speed beside the prediction."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rig.analysis.findings.intervals import RAYLEIGH95
from rig.analysis.friction.coasting import Coasting
from rig.analysis.identify.identified import Identified, order_amplitudes, order_phases
from rig.analysis.identify.predictions import Prediction
from rig.analysis.identify.undetermined import NOTHING
from rig.core.quantiles import Z95
from rig.core.units import ARCMIN, ARCSEC, DEG
from rig.model.gearfile import CHARACTERISTICS, UNITS, GearFile, MeasuredSeries, Parameter
from rig.report.numbers import estimate, quantity

SHOWN = {"rad": (1 / ARCMIN, "arcmin"), "J": (1e3, "mJ"), "s": (1e6, "µs")}  # SI to what people read
UNITS_BESIDE = {
    "B_sum": "N·m·s/rad",
    "omega_n": "rad/s",
    "zeta": "1",
    "skew": "s",
    "lag": "s",
    "zero": "N·m",
}
WORDS = {
    "N": "gear ratio",
    "J_m": "inertia, motor side",
    "J_l": "inertia, load",
    "K": "torsional stiffness of the whole path",
    "B_sp": "damping of the spring",
    "B_sum": "drag on the motor, B_m + B_ml·(1 + σ/N)²",
    "B_m": "its part on the motor",
    "B_ml": "its part between wave generator and output",
    "B_l": "drag on the load",
    "tau_c": "Coulomb friction, motor side",
    "tau_s": "friction at standstill, motor side",
    "omega_s": "speed over which it falls",
    "F_cl": "Coulomb friction, load side",
    "omega_n": "natural frequency, both ends free",
    "zeta": "damping ratio of that mode",
    "skew": "how much older load angles are than motor angles beside them",
    "lag": "how much older torques are than load angles beside them",
    "zero": "torque sensor with no torque",
}


def report(found: Identified, simulated: bool, used: int, of: int) -> list[str]:
    """Parameters with 95 % intervals and origin, and the orders of θ̃_p."""
    lines = [f"{'SIMULATED ' if simulated else ''}identified from {used} of {of} runs; ± is the 95 % interval"]
    units, shown = UNITS | UNITS_BESIDE, [name for name in WORDS if name in found.parameters]
    lines += [parameter_line(name, found.parameters[name], units[name]) for name in shown]
    return [*lines, *series_lines(found.series)]


def parameter_line(name: str, p: Parameter, unit: str) -> str:
    """One parameter for people."""
    scale, shown = SHOWN.get(unit, (1.0, unit))
    interval = (scale * p.interval[0], scale * p.interval[1])
    value = "unknown" if p.note == NOTHING else estimate(scale * p.value, interval, shown)
    origin = p.origin if p.origin != "measured" else f"measured, {counted(p.runs)}" if p.runs else "measured"
    note = f"; {p.note}" if p.note and p.note not in WORDS[name] else ""  # said once
    return f"  {name:8s} {value:36s} {WORDS[name]} ({origin}{note})"


def counted(runs: tuple[str, ...]) -> str:
    """How many they are."""
    return f"{len(runs)} {'run' if len(runs) == 1 else 'runs'}"


def series_lines(series: MeasuredSeries) -> list[str]:
    """C_n and ψ_n of the orders that stand out."""
    if series.origin != "measured":
        return ["  θ̃_p      not determined: none of these runs shows the kinematic error"]
    lines = [f"  θ̃_p      {series.series.peak_to_peak() / ARCSEC:.1f} arcsec peak to peak, orders:"]
    for (n, size, u), (psi, u_psi) in zip(order_amplitudes(series), order_phases(series), strict=True):
        amplitude = quantity(size / ARCSEC, Z95 * u / ARCSEC, "arcsec")
        told = size > RAYLEIGH95 * u  # below, the phase may be any
        phase = f"at {quantity(psi / DEG, Z95 * u_psi / DEG, '°')}" if told else "(not told from zero)"
        lines.append(f"    C_{n:<3d} {amplitude:28s} {phase}")
    return lines


def comparison(rows: Sequence[Prediction]) -> list[str]:
    """Recorded against predicted at every speed."""
    if not rows:
        return []
    width = max(len(p.run) for p in rows)  # whole names: cut ones are alike
    head = f"  {'θ̃ at speed, peak to peak, arcsec':{width + 3}s}"  # its tilde takes no room of its own
    lines = [f"{head}  motor speed       measured      predicted  pure θ̃_p  rms between"]
    for p in rows:
        measured, predicted = estimate(p.measured, p.interval), quantity(p.predicted, p.half)
        lines.append(
            f"    {p.run:{width}s} {p.speed_rpm:+8.1f} rpm {measured:>14s} {predicted:>14s} {p.pure:9.1f} {p.rms:12.2f}"
        )
    lines.append(
        "    predicted at a torque of the motor that is constant: a loop that holds the speed bends the waveform"
    )
    return lines


def coasting(found: Sequence[Coasting]) -> list[str]:
    """What coast-downs say of the inertia at the motor, which no fit has used, against J_m + J_l/N²."""
    return [
        f"  {one.run} coasts with {estimate(one.inertia.value, one.inertia.ci95, one.inertia.unit)}, J_m + J_l/N² is "
        f"{estimate(one.value, (one.value - one.half, one.value + one.half), one.inertia.unit)}: they "
        f"{'agree' if one.agrees else 'do not agree: look at the friction between both'}"
        for one in found
    ]


def breakaway_beside(file: GearFile) -> list[str]:
    """What was measured at rest, where the model's own friction at standstill was not."""
    measured, model = file.characteristics.get("tau_break"), file.parameters["tau_s"]
    if measured is None or model.origin == "measured":
        return []
    return [
        f"  the motor broke away at {quantity(measured.value, measured.half, 'N·m')} ({counted(measured.runs)}), "
        f"tau_s of the model is {model.value:.4g} N·m ({model.origin}): simulate --start goes by what was measured"
    ]


def characteristic_lines(found: Mapping[str, Parameter]) -> list[str]:
    """One line each."""
    lines = []
    for name, p in found.items():
        scale, unit = SHOWN.get(CHARACTERISTICS[name], (1.0, CHARACTERISTICS[name]))
        value = estimate(scale * p.value, (scale * p.interval[0], scale * p.interval[1]), unit)
        lines.append(f"  {name:17s} {value:36s} {p.note} ({counted(p.runs)})")
    return lines
