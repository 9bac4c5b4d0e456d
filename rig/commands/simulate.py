"""hdrig simulate GEAR: the steady kinematic error at constant torque, from a gear file or a bench; moves nothing."""

from __future__ import annotations

import argparse
import math
import tomllib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from rig.commands.targets import refuse_taken
from rig.core.errors import Exit, UsageError
from rig.core.units import ARCSEC, RPM
from rig.runfile.manifest import write_atomic
from rig.runfile.writing import writing

if TYPE_CHECKING:
    from rig.model.gear import Gear
    from rig.model.gearfile import GearFile
    from rig.model.simulate import Waveform

Array = npt.NDArray[np.float64]
SPEEDS = (120.0, 300.0, 500.0)  # rpm, the paper's Fig. 11
NEAR = 0.05  # of an end of what was covered: a speed held by a constant torque is a few per cent off
ORDERS = 8  # printed; beyond, amplitudes are below what a rig resolves
HEAD = (  # each ends in its unit; p-p is peak to peak over one turn of the wave generator
    "motor speed, rpm",
    "motor torque τ, N·m",
    "θ̃ p-p, arcsec",
    "θ̃_p p-p (pure part), arcsec",
    "θ̃_s p-p (flexible part), arcsec",
    "motor speed p-p, rpm",
    "shaft torque τ_l p-p, N·m",
)

SPEED, TORQUE = 0, 1  # of these, which one may be held


def arguments(parser: argparse.ArgumentParser) -> None:
    """Options of `hdrig simulate`."""
    parser.add_argument("gear", metavar="GEAR", help="gear file of hdrig identify; or a bench, by name or file")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--speed", type=float, nargs="+", metavar="RPM", help="mean motor speeds, default 120 300 500")
    what.add_argument("--torque", type=float, nargs="+", metavar="N·m", help="constant motor torques instead")
    what.add_argument(
        "--start", type=float, nargs="+", metavar="N·m", help="motor torques switched on at rest: whether it runs up"
    )
    parser.add_argument("--load", type=float, default=0.0, metavar="N·m", help="on the output, + drives it forward")
    parser.add_argument("-o", "--out", type=Path, metavar="FILE", help="the first one's figure, as .svg or .html")


def run(args: argparse.Namespace) -> int:
    """One line a speed, orders below, and the figure where asked for."""
    from rig.model.simulate import at_speed, steady_state

    if args.out is not None and args.out.suffix not in (".svg", ".html"):
        raise UsageError(f"--out {args.out}: expected a name that ends in .svg or .html")
    if args.out is not None:
        refuse_taken(args.out, "--out")
    if not math.isfinite(args.load):
        raise UsageError(f"--load {args.load:g}: expected a torque in N·m")
    for rpm in args.speed or ():
        if not math.isfinite(rpm) or rpm == 0:
            raise UsageError(f"--speed {rpm:g} rpm: expected a mean speed of the motor in rpm, either way, not 0")
    for tau in args.torque or ():
        if not math.isfinite(tau):
            raise UsageError(f"--torque {tau:g}: expected a torque of the motor in N·m")
    file = open_gear(args.gear)
    gear = file.gear()
    if args.start:
        return starts(file, args)
    if args.torque:
        waves = [_found(steady_state, gear, tau, args.load, f"{tau:g} N·m") for tau in args.torque]
    else:
        waves = [_found(at_speed, gear, rpm * RPM, args.load, f"{rpm:g} rpm") for rpm in args.speed or SPEEDS]
    print(f"SIMULATED by equations 6-7 from {args.gear}, gear {file.serial or '(no serial)'}, load {args.load:g} N·m")
    print(describe(file, waves, args.load, by_torque=bool(args.torque)))
    for sentence in beyond(file, [wave.mean_speed / RPM for wave in waves], args.load):
        print(sentence)
    if args.out is not None:
        draw(args.out, waves[0], f"{args.gear}")
        print(f"figure {args.out}")
    return int(Exit.PASS)


def _found(
    solve: Callable[[Gear, float, float], Waveform], gear: Gear, wanted: float, load: float, asked: str
) -> Waveform:
    """The steady state. Raises NoSteadyState in the units of whoever `asked`."""
    from rig.model.simulate import NoSteadyState

    try:
        return solve(gear, wanted, load)
    except NoSteadyState as why:
        raise NoSteadyState(f"at {asked} under a load of {load:g} N·m: {why}") from None


def starts(file: GearFile, args: argparse.Namespace) -> int:
    """One line a torque: does it run up from rest, to which speed, in what time. Raises UsageError: with a figure."""
    from rig.commands.starts import lines, run_ups, speeds_reached

    if args.out is not None:
        raise UsageError("--out draws a steady turn: it goes with --speed or --torque, not with --start")
    made = run_ups(file, args.start, args.load)
    print(f"SIMULATED by equations 6-7 from {args.gear}, gear {file.serial or '(no serial)'}, load {args.load:g} N·m")
    print("\n".join(lines(file, args.start, made)))
    for sentence in beyond(file, speeds_reached(made), args.load):
        print(sentence)
    return int(Exit.PASS)


def beyond(file: GearFile, speeds_rpm: Sequence[float], load: float) -> list[str]:
    """What lies outside the runs the gear was identified from, one sentence each; nothing of a gear nobody measured."""
    if file.covered is None:
        return []
    asked = [(abs(rpm), file.covered.speed_rpm, "rpm") for rpm in speeds_rpm]
    found = [*asked, (load, file.covered.load, "N·m of load")]
    return [
        f"  extrapolated: {value:.4g} {unit}; the gear was identified from {_between(ends, unit)}"
        for value, ends, unit in found
        if not ends[0] - NEAR * abs(ends[0]) <= value <= ends[1] + NEAR * abs(ends[1])
    ]


def _between(ends: tuple[float, float], unit: str) -> str:
    return f"{ends[0]:.4g} {unit} alone" if ends[0] == ends[1] else f"{ends[0]:.4g} to {ends[1]:.4g} {unit}"


def open_gear(source: str) -> GearFile:
    """The gear file `source`, or the gear of a bench. Raises UsageError: neither, or no kinematic error in it."""
    from rig import bench
    from rig.model import gearfile

    path = Path(source)
    if path.is_file():
        try:
            schema = tomllib.loads(path.read_text(encoding="utf-8")).get("schema", "")
        except (OSError, ValueError, RecursionError):
            schema = ""
        if not str(schema).startswith("hdrig.bench/"):
            return gearfile.read(path)
    found = bench.read(source)
    if found.file.twin is None:
        raise UsageError(f"{found.source} says nothing of a kinematic error; identify the gear and give its gear file")
    gear: Gear = bench.twin_parameters(found.file).gear
    return gearfile.declared(gear, "declared", found.file.gear.serial, True)


def figures(wave: Waveform) -> Array:
    """What the table shows of a waveform, in its units, then the amplitudes of the orders in arcsec."""
    curves = (wave.kinematic_error, wave.pure, wave.flexible)
    swings = [float(np.ptp(c)) / ARCSEC for c in curves]
    head = [wave.mean_speed / RPM, wave.tau, *swings, float(np.ptp(wave.omega_m)) / RPM]
    orders = np.abs(wave.orders(wave.kinematic_error, ORDERS)) / ARCSEC
    return np.array([*head, float(np.ptp(wave.shaft_torque)), *orders])


def describe(file: GearFile, waves: Sequence[Waveform], load: float, by_torque: bool = False) -> str:
    """The table, with 95 % intervals where the gear file has any: of what is not held, speed or torque, as well."""
    from rig.model.simulate import at_speed, steady_state
    from rig.model.simulate.spread import drawn_gears, half_widths
    from rig.report.numbers import quantity

    gears = drawn_gears(file)
    names = (*HEAD, *(f"amplitude of θ̃, order {n}, arcsec" for n in range(1, ORDERS + 1)))
    columns = []
    for wave in waves:
        solve, held = (steady_state, wave.tau) if by_torque else (at_speed, wave.mean_speed)
        halves = half_widths(gears, lambda g, solve=solve, held=held: figures(solve(g, held, load)))  # type: ignore[misc]
        values = figures(wave)
        halves = np.resize(halves, values.size)
        halves[TORQUE if by_torque else SPEED] = np.nan
        columns.append([quantity(v, h) for v, h in zip(values, halves, strict=True)])
    width = max(len(n) for n in names)
    lines = [f"  {n:{width}s}  " + "  ".join(f"{c[i]:>18s}" for c in columns) for i, n in enumerate(names)]
    how = f"± 95 %: {len(gears)} gears drawn from the gear file" if gears else "no intervals: nothing was measured"
    return "\n".join([*lines, f"  ({how}; means over time, p-p and amplitudes over the wave-generator angle)"])


def draw(path: Path, wave: Waveform, source: str) -> None:
    """The figure, marked SIMULATED. Raises UsageError when it cannot be written."""
    from rig.report.figures import Frame, svg
    from rig.report.figures.simulated import DRAWING

    text = svg(DRAWING, curves(wave), Frame(mark="SIMULATED")) or ""
    if path.suffix == ".html":
        title = f"{DRAWING.title}: {wave.mean_speed / RPM:.1f} rpm, {wave.tau:.3f} N·m, {source}"
        title = title.replace("&", "&amp;").replace("<", "&lt;")
        text = f'<!doctype html><meta charset="utf-8"><title>{title}</title><h1>{title}</h1>{text}<p>{DRAWING.note}</p>'
    with writing(path):
        write_atomic(path, text.encode())


def curves(wave: Waveform) -> dict[str, Array]:
    """Curves of the drawing, arcsec and N·m about their means, on 512 points of the trigonometric interpolant."""
    made = {"total": wave.kinematic_error, "pure": wave.pure, "flexible": wave.flexible}
    scaled = {name: (c - c.mean()) / ARCSEC for name, c in made.items()}
    scaled["torque"] = wave.shaft_torque - wave.shaft_torque.mean()
    out = {f"steady.{name}": fine(c) for name, c in scaled.items()}
    out["steady.theta_deg"] = np.linspace(0.0, 360.0, 512, endpoint=False)
    return out


def fine(curve: Array) -> Array:
    """A periodic curve on 512 points."""
    return np.asarray(np.fft.irfft(np.fft.rfft(curve), 512) * (512 / curve.size))
