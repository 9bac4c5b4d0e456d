"""`hdrig simulate --start`: a torque switched on at rest, in lines for people."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from rig.core.errors import UsageError
from rig.core.quantiles import Z95
from rig.core.units import RPM
from rig.model.gearfile import GearFile
from rig.model.simulate.run_up import RunUp, run_up
from rig.model.simulate.spread import drawn_gears
from rig.model.simulate.steady import refuse_load
from rig.report.numbers import quantity

SECONDS = 5.0  # what constant-torque lets a run settle: twelve time constants of inertia over drag of the paper's gear
HARDLY = 0.01  # motor turns: the spring gives so much before anything slides
Array = npt.NDArray[Any]


def run_ups(file: GearFile, torques: Sequence[float], load: float) -> list[RunUp]:
    """Each torque by the gear file's gear and as many drawn from its intervals. Raises UsageError: no numbers,
    NoSteadyState: a load beyond any gear.
    """
    if not np.isfinite(torques).all():
        raise UsageError(f"--start {' '.join(f'{x:g}' for x in torques)}: expected torques in N·m")
    file = broken_away(file)
    gears = [file.gear(), *drawn_gears(file)]
    refuse_load(gears[0], load)
    return [run_up(gears, tau, SECONDS, load) for tau in torques]


def broken_away(file: GearFile) -> GearFile:
    """With the torque at which the motor broke away from rest for its friction there, where only that was measured."""
    measured, model = file.characteristics.get("tau_break"), file.parameters["tau_s"]
    if measured is None or model.origin == "measured" or measured.value < file.parameters["tau_c"].value:
        return file
    return replace(file, parameters={**file.parameters, "tau_s": replace(measured, origin="measured")})


def speeds_reached(made: Sequence[RunUp]) -> list[float]:
    """Motor speeds, rpm, at which the gear file's own gear keeps turning."""
    return [float(one.speed[0]) / RPM for one in made if one.turning[0]]


def lines(file: GearFile, torques: Sequence[float], made: Sequence[RunUp]) -> Iterator[str]:
    """A line a torque."""
    yield f"{'τ, N·m':>10s}{'does it turn':>22s}{'motor speed, rpm':>20s}{'run up in, s':>20s}"
    for tau, one in zip(torques, made, strict=True):
        yield line(tau, one)
    drawn = made[0].turning.size - 1
    how = f"± 95 %: {drawn} gears drawn from the gear file" if drawn else "no intervals: nothing was measured"
    yield f"  ({how}; motor speed: mean from {0.8 * SECONDS:g} to {SECONDS:g} s; run up: 95 % of it)"
    tau_s = broken_away(file).parameters["tau_s"]
    if tau_s.origin == "measured":
        yield f"  (breakaway {quantity(tau_s.value, tau_s.half)} N·m, measured)"
    else:
        yield f"  breakaway was not measured (tau_s {tau_s.value:.3g} N·m {tau_s.origin}): what starts hangs on it"


def line(tau: float, made: RunUp) -> str:
    """One torque; the first gear is the file's own."""
    turning, drawn = made.turning[0], made.turning[1:]
    share = f" ({drawn.sum()} of {drawn.size})" if drawn.size else ""
    if not turning:
        return f"{tau:10.4g}{('no' + share):>22s}   {went(float(made.moved[0]))}"
    speed, time = made.speed / RPM, made.time
    return (
        f"{tau:10.4g}{('yes' + share):>22s}{quantity(speed[0], _half(speed[1:], drawn)):>20s}"
        f"{quantity(time[0], _half(time[1:], drawn)):>20s}"
    )


def went(turns: float) -> str:
    """What became of a motor that does not keep turning, after its `turns` in all."""
    if not math.isfinite(turns):
        return "its motion grows beyond all numbers: a gear with these parameters and this torque there is not"
    return f"it stops or sticks after {turns:.2g} motor turns" if turns >= HARDLY else "it does not start"


def _half(values: Array, drawn: Array) -> float:
    """Half of the 95 % interval over the drawn gears that turn; NaN with fewer than two."""
    there = values[drawn]
    return float(Z95 * np.std(there, ddof=1)) if there.size > 1 else float("nan")
