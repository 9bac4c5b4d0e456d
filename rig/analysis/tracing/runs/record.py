"""From a run folder to a recording: its columns on an even grid at the working rate, piece by piece."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rig.analysis.motion.smallest_step import smallest_step
from rig.analysis.motion.source import Source
from rig.analysis.motion.tame import Tame
from rig.analysis.tracing.runs.as_read import AsRead, as_read
from rig.analysis.tracing.runs.clocked import slowed
from rig.analysis.tracing.runs.declared import believed, is_locked, locked_all_the_same, stated, states
from rig.analysis.tracing.runs.derived import derived
from rig.analysis.tracing.runs.grid import is_even, uniform
from rig.analysis.tracing.runs.input_locked import is_input_locked
from rig.analysis.tracing.runs.late import earlier
from rig.analysis.tracing.runs.look import FIRST, Look
from rig.analysis.tracing.runs.meanings import computed_torque
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.runs.resolution import counts_of, noise_of, quiet
from rig.analysis.tracing.runs.sliding import direction
from rig.analysis.tracing.runs.smoothing import Smoother, thin
from rig.analysis.tracing.runs.stand_ins import substituted
from rig.analysis.tracing.thresholds import BANDWIDTH, FASTER, RATE
from rig.core.drivetrain import RATIOS
from rig.core.errors import UsageError
from rig.model.effect import Array, Signals
from rig.runfile.run import Run

TAMEST = 1 / 7  # of the sample rate: the widest low-pass whose second derivative is free of aliases


def record(whole_run: Run, start: float, hz: float | None = None, look: Look = FIRST) -> Recording:
    """The run, `start` s after the campaign began; what is absurd in it counts as missing. Rows of a run without a time
    that declares its speed come `hz` times a second, where that is known. A fast `look` takes more of them. Raises
    UsageError when the run has no angle it can use, rows too far apart or too close, or a ratio no gear has.
    """
    run = Tame(whole_run)
    _refuse_ratio(run.ratio)
    read = as_read(run, whole_run.rows, hz)
    encoders = run.manifest.get("encoders") or {}
    theta_m, theta_l = read.columns["theta_m"], read.columns["theta_l"]
    factor, smoother = _smoothing(theta_m, read.dt, encoders, look)
    columns = {name: _forward(name, x, look, read.dt) for name, x in read.columns.items()}
    made = _pieces(run, replace(read, columns=columns), start, factor, smoother)
    if hz is not None and "t" not in read.has and run.procedure == "kinematic_error":
        made = tuple(slowed(piece) for piece in made)
    held = is_input_locked(read.columns, run.ratio)
    about_the_lock = () if held else locked_all_the_same(run)
    return Recording(
        name=run.name,
        procedure=run.procedure,
        said=f"{run.procedure} {sorted((k, v) for k, v in run.conditions.items() if k != 'note')}",
        locked=is_locked(run) or held,
        start=start,
        ratio=run.ratio,
        pieces=made,
        smoother=smoother,
        has=read.has,
        counts_m=counts_of(theta_m, float(encoders.get("motor_counts_per_rev") or 0.0)),
        counts_l=counts_of(theta_l, float(encoders.get("load_counts_per_rev") or 0.0)),
        rate=1 / read.dt,
        thinned=factor,
        noise=_noise(replace(read, columns=columns), encoders, factor),
        notes=(*run.notes, *about_the_lock, *read.notes, *computed_torque(whole_run)),
        step_m=0.0 if theta_m is None else smallest_step(theta_m),
        step_l=0.0 if theta_l is None else smallest_step(theta_l),
        speed_rpm=abs(stated(run.conditions, "speed_rpm", 0.0)),
        declared={n: abs(s) for n in ("K", "J_m", "J_l") if (s := stated(run.declared, n, 0.0))},
        look=look,
        clocked=read.clocked,
        load_stated=states(run.conditions, "tau_ext"),
        input_locked=held,
    )


def _refuse_ratio(ratio: float) -> None:
    if not RATIOS[0] <= ratio <= RATIOS[1]:
        raise UsageError(f"gear.ratio is {ratio:g}, expected {RATIOS[0]:g} to {RATIOS[1]:g}")


def _smoothing(theta_m: Array | None, dt: float, encoders: Mapping[str, float], look: Look) -> tuple[int, Smoother]:
    """One of how many rows, `dt` apart, is worked with, and the low-pass: twice as many and as wide as usual where a
    `look` is fast, and narrower where it says so or the motor's encoder is coarse."""
    often, narrow = FASTER if look.fast else 1.0, look.narrow or np.inf
    factor = max(1, round(1 / dt / (often * RATE)))
    work = dt * factor
    sigma, of_the_motor = (
        min(TAMEST / work, narrow, quiet(theta_m, encoders, width)) for width in (often * BANDWIDTH, BANDWIDTH)
    )
    return factor, Smoother(sigma, work, 2 if 1 / work > 3 * sigma else 1, of_the_motor)


def _noise(read: AsRead, encoders: Mapping[str, float], factor: int) -> dict[str, float]:
    """RMS of white noise in what was measured, of one row where `factor` rows are made one."""
    uneven = None if is_even(read.t, read.dt) else read.t
    seen = {name: x for name, x in read.columns.items() if x is not None}
    return {name: noise_of(name, x, encoders, uneven) / float(np.sqrt(factor)) for name, x in seen.items()}


def _forward(name: str, x: Array | None, look: Look, dt: float) -> Array | None:
    """A column as it is looked at, its rows `dt` apart."""
    late = {"tau_l": look.late_torque, "theta_l": look.late_load}.get(name, 0.0)
    return earlier(x, late / dt) if late and x is not None else x


def _pieces(run: Source, read: AsRead, start: float, factor: int, smooth: Smoother) -> tuple[Signals, ...]:
    """Rows that follow each other, where they are enough for the low-pass."""
    columns, timed = read.filled(), "t" in read.has
    made = []
    for lo, hi in read.unbroken:
        first, c = _thinned(read.t[lo:hi], {name: x[lo:hi] for name, x in columns.items()}, read.dt, factor)
        if c["theta_m"].size >= 10 * smooth.half:
            made.append(_piece(run, start + first, c, smooth, factor, timed))
    return tuple(made)


def _thinned(t: Array, columns: Mapping[str, Array], dt: float, factor: int) -> tuple[float, dict[str, Array]]:
    """s of the first row, and the columns on an even grid of `factor` times `dt`, without what that cannot hold."""
    even = {name: uniform(t, x, dt) for name, x in columns.items()}
    if factor == 1:
        return float(t[0]), even
    thinned = {name: thin(x, factor) for name, x in even.items()}
    return float(t[0]) + thinned["theta_m"][1] * dt, {name: x for name, (x, _) in thinned.items()}


def _piece(run: Source, start: float, c: dict[str, Array], smooth: Smoother, factor: int, timed: bool) -> Signals:
    """One piece at the working rate, from `start` s on."""
    n, tau_ext = c["theta_m"].size, stated(run.conditions, "tau_ext", 0.0)
    c = substituted(c, smooth.dt, run, tau_ext, timed)
    return Signals(
        t=start + smooth.dt * np.arange(n, dtype=np.float64),
        dt=smooth.dt,
        ratio=run.ratio,
        theta_m=c["theta_m"],
        theta_l=c["theta_l"],
        tau_m=c["tau_m"],
        tau_l=c["tau_l"],
        tau_ext=np.full(n, tau_ext),
        way=direction(smooth.same(c["theta_m"], 1), smooth.dt),
        temperature=c["temperature"],
        gear=believed(run),
        thinned=factor,
        past=(),
        cut=None,
        **derived(c, smooth),
    )
