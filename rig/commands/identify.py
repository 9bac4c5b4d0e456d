"""hdrig identify CAMPAIGN: all runs of one gear to the parameters of equations 6-8 and a gear file; moves nothing."""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from rig.commands.folders import expand, runs_argument
from rig.commands.targets import refuse_unwritable
from rig.core.errors import DataError, Exit, UsageError
from rig.core.units import ARCMIN, ARCSEC, DEG, RPM

if TYPE_CHECKING:
    from rig.analysis.findings.result import Result
    from rig.analysis.identify.identified import Identified
    from rig.analysis.identify.predictions import Prediction
    from rig.analysis.identify.recording import Recording
    from rig.model.gearfile import Covered, GearFile, MeasuredSeries, Parameter
    from rig.runfile.run import Run

TERMS = 15  # orders of the paper's series
MOST_TERMS = 40  # a row rate of 1 kHz shows no more at the usual speeds
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
    "skew": "load encoder read late, after the motor's",
    "lag": "torque sensor read late, after the load encoder",
    "zero": "torque sensor with no torque",
}


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig identify`."""
    runs_argument(parser)
    parser.add_argument("-o", "--out", type=Path, metavar="FILE", help="gear file to write, for example gear.toml")
    parser.add_argument("--terms", type=int, default=TERMS, metavar="K", help=f"orders of θ̃_p, default {TERMS}")


def run(args: argparse.Namespace) -> int:
    """Report on stdout, gear file where asked for."""
    if not 1 <= args.terms <= MOST_TERMS:
        raise UsageError(f"--terms {args.terms}: expected 1 to {MOST_TERMS} orders")
    return identify(args.runs, args.out, args.terms)


def identify(paths: list[Path], out: Path | None, terms: int = TERMS) -> int:
    """Report of all runs below `paths` on stdout, gear file at `out`. Raises UsageError when that is there already."""
    from rig.analysis.identify.fit import fit
    from rig.analysis.identify.identified import identified
    from rig.analysis.identify.predictions import predictions
    from rig.analysis.identify.undetermined import said_open
    from rig.model import gearfile

    if out is not None and out.exists():
        raise UsageError(f"{out} exists already; give the name of a new file")
    if out is not None:
        refuse_unwritable(out.parent, "-o")
    runs, recordings = open_runs(paths)
    found = identified(fit(recordings, terms, say), runs[0].manifest)
    simulated = any(r.simulated for r in runs)
    characteristics = beside(runs)
    if not characteristics:
        refuse_nothing(found, recordings)
    tell(report(found, simulated, len(recordings), len(runs)))
    gear = runs[0].manifest.get("gear") or {}
    if found.undetermined:
        print(f"  {said_open(found.undetermined, found.parameters)}")
    file = found.gear_file(str(gear.get("serial") or ""), simulated, made_with(runs))
    tell(comparison(predictions(recordings, file.gear(), terms)))
    tell(coasting(runs, found))
    file = replace(file, characteristics=characteristics, covered=covered(found))
    tell(characteristic_lines(characteristics))
    tell(breakaway_beside(file))
    tell([f"  cannot tell: {sentence}" for sentence in found.cannot])
    if out is not None:
        gearfile.write(out, file)
        print(f"gear file {out}")
    return int(Exit.INCOMPLETE if found.undetermined else Exit.PASS)


def tell(lines: list[str]) -> None:
    """On stdout."""
    for line in lines:
        print(line)


def refuse_nothing(found: Identified, recordings: list[Recording]) -> None:
    """Raises DataError where not one number is measured: a gear file of what was declared says nothing new."""
    if any(p.origin == "measured" for p in found.parameters.values()) or found.series.origin == "measured":
        return
    kinds = ", ".join(sorted({r.source.procedure.replace("_", "-") for r in recordings}))
    raise DataError(
        f"nothing of the gear can be determined from what is here ({kinds}): it takes runs in which the motor turns "
        "at constant speed, or a lock test beside a slow run"
    )


def say(text: str) -> None:
    """Progress, on stderr."""
    print(f"identify: {text}", file=sys.stderr)


def open_runs(paths: list[Path]) -> tuple[list[Run], list[Recording]]:
    """All runs of the campaign, and those that identification can read. Raises DataError when none, or two gears."""
    from rig.analysis.identify.recording import recording
    from rig.runfile.run import Run

    runs = []
    for folder in expand(paths):
        one = Run.open(folder)
        if one.manifest.get("status") in ("completed", "imported", None) and one.procedure != "other":
            runs.append(one)
    if not runs:
        raise DataError("no completed run of an experiment among these folders: nothing to identify from")
    for what, values in (
        ("gear ratios", {r.ratio for r in runs}),
        ("gears", {(r.manifest.get("gear") or {}).get("serial") for r in runs}),
        ("assemblies", {r.conditions.get("assembly", 1) for r in runs}),
    ):
        if len(values) > 1:
            words = ", ".join(map(str, sorted(map(str, values))))
            raise DataError(f"these runs are of {len(values)} {what} ({words}): identify one at a time")
    found = [r for one in runs if (r := recording(one)) is not None]
    if not found:
        raise DataError("no run here has time and both angles: nothing to identify from")
    return runs, found


def report(found: Identified, simulated: bool, used: int, of: int) -> list[str]:
    """Parameters with 95 % intervals and origin, and the orders of θ̃_p."""
    from rig.model.gearfile import UNITS

    lines = [f"{'SIMULATED ' if simulated else ''}identified from {used} of {of} runs; ± is the 95 % interval"]
    units, shown = UNITS | UNITS_BESIDE, [name for name in WORDS if name in found.parameters]
    lines += [parameter_line(name, found.parameters[name], units[name]) for name in shown]
    return [*lines, *series_lines(found.series)]


def parameter_line(name: str, p: Parameter, unit: str) -> str:
    """One parameter for people."""
    from rig.analysis.identify.undetermined import NOTHING
    from rig.report.numbers import estimate

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
    from rig.analysis.identify.identified import order_amplitudes, order_phases
    from rig.report.numbers import quantity

    if series.origin != "measured":
        return ["  θ̃_p      not determined: none of these runs shows the kinematic error"]
    lines = [f"  θ̃_p      {series.series.peak_to_peak() / ARCSEC:.1f} arcsec peak to peak, orders:"]
    for (n, size, u), (psi, u_psi) in zip(order_amplitudes(series), order_phases(series), strict=True):
        amplitude = quantity(size / ARCSEC, 1.96 * u / ARCSEC, "arcsec")
        told = size > 2.45 * u  # below, the phase may be any
        phase = f"at {quantity(psi / DEG, 1.96 * u_psi / DEG, '°')}" if told else "(not told from zero)"
        lines.append(f"    C_{n:<3d} {amplitude:28s} {phase}")
    return lines


def comparison(rows: list[Prediction]) -> list[str]:
    """Recorded against predicted at every speed."""
    from rig.report.numbers import estimate

    if not rows:
        return []
    width = max(len(p.run) for p in rows)  # whole names: cut ones are alike
    head = f"  {'θ̃ at speed, peak to peak, arcsec':{width + 3}s}"  # its tilde takes no room of its own
    lines = [f"{head}  motor speed       measured  predicted  pure θ̃_p  rms between"]
    for p in rows:
        measured = estimate(p.measured, p.interval)
        lines.append(
            f"    {p.run:{width}s} {p.speed_rpm:+8.1f} rpm {measured:>14s} {p.predicted:10.1f} {p.pure:9.1f} "
            f"{p.rms:12.2f}"
        )
    return lines


def coasting(runs: list[Run], found: Identified) -> list[str]:
    """What coast-downs say of the inertia at the motor, which no fit here has used, against J_m + J_l/N²."""
    from rig.analysis import analyse
    from rig.report.numbers import estimate

    p = found.parameters
    lines: list[str] = []
    if not {"J_m", "J_l"} <= p.keys():
        return lines
    N = p["N"].value
    value, half = p["J_m"].value + p["J_l"].value / N**2, math.hypot(p["J_m"].half, p["J_l"].half / N**2)
    for run in runs:
        for e in seen(run, analyse(run)).estimates if run.procedure == "coast_down" else ():
            if e.name == "inertia_at_motor":
                apart = abs(e.value - value) / math.hypot(0.5 * (e.ci95[1] - e.ci95[0]), half)
                agree = "agree" if apart <= 1.0 else "do not agree: look at the friction between both"
                lines.append(
                    f"  {run.name} coasts with {estimate(e.value, e.ci95, e.unit)}, J_m + J_l/N² is "
                    f"{estimate(value, (value - half, value + half), e.unit)}: they {agree}"
                )
    return lines


def beside(runs: list[Run]) -> dict[str, Parameter]:
    """What lock tests and friction runs say that the model has no parameter for, each analysed as by itself."""
    from rig.analysis import analyse
    from rig.analysis.friction.characteristics import characteristics
    from rig.commands.reference import reference_of_one_zero

    told = [r for r in runs if r.procedure in ("stiffness_lock", "friction")]
    if told:
        say("lock tests and breakaway")
    return characteristics([(r.name, seen(r, analyse(r, reference_of_one_zero(r)))) for r in told])


def seen(run: Run, result: Result) -> Result:
    """`result`, after a word on stderr where its analysis broke off."""
    if result.broke_off:
        say(f"{run.name}: {result.sentence} hdrig analyse {run.name} keeps where it did.")
    return result


def covered(found: Identified) -> Covered | None:
    """Speeds and loads of the stretches of constant speed the numbers come from; None without any."""
    from rig.model.gearfile import Covered

    speeds = [abs(m.omega) / RPM for m in found.fits.means]
    loads = [m.tau_ext for m in found.fits.means]
    return Covered((min(speeds), max(speeds)), (min(loads), max(loads))) if speeds else None


def breakaway_beside(file: GearFile) -> list[str]:
    """What was measured at rest, where the model's own friction at standstill was not."""
    from rig.report.numbers import quantity

    measured, model = file.characteristics.get("tau_break"), file.parameters["tau_s"]
    if measured is None or model.origin == "measured":
        return []
    return [
        f"  the motor broke away at {quantity(measured.value, measured.half, 'N·m')} ({counted(measured.runs)}), "
        f"tau_s of the model is {model.value:.4g} N·m ({model.origin}): simulate --start goes by tau_s"
    ]


def characteristic_lines(found: Mapping[str, Parameter]) -> list[str]:
    """One line each."""
    from rig.model.gearfile import CHARACTERISTICS
    from rig.report.numbers import estimate

    lines = []
    for name, p in found.items():
        scale, unit = SHOWN.get(CHARACTERISTICS[name], (1.0, CHARACTERISTICS[name]))
        value = estimate(scale * p.value, (scale * p.interval[0], scale * p.interval[1]), unit)
        lines.append(f"  {name:17s} {value:36s} {p.note} ({counted(p.runs)})")
    return lines


def made_with(runs: list[Run]) -> str:
    """When and with what."""
    from rig.software import software

    said, started = software(), sorted(str(r.manifest.get("started_utc") or "") for r in runs)
    days = f"{started[0][:10]} to {started[-1][:10]}"
    return f"hdrig {said.get('version')} {said.get('commit') or ''}, runs of {days}"
