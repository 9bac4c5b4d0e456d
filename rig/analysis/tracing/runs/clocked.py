"""Seconds between rows that have none, by the speeds that runs declare: a logger without a clock keeps its rate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.motion.source import Source
from rig.analysis.tracing.runs.declared import stated
from rig.core.units import RPM
from rig.model.effect import Signals
from rig.runfile.run import Run

FEWEST: Final = 4  # runs: of fewer, a rate that they agree on may be chance
AGREE: Final = 0.1  # relative, from the middle: a motor under a constant torque keeps its speed to a few per cent
ROUND: Final = (1.0, 1.25, 2.0, 2.5, 4.0, 5.0, 8.0)  # times a power of ten: what loggers are set to
NEARLY: Final = 0.03  # relative, of a rate by all runs together from a round one
ONE_WAY: Final = 0.98  # of the way
SLOW: Final = 0.2  # rad/s of the motor: it shakes nothing, not even where it turns back
SOME: Final = 500  # rows that a speed is read from
MOST: Final = 0.75  # of those runs that have to agree


def rate_by_speed(runs: Sequence[Run]) -> float | None:
    """Rows a second of runs without a time that declare a speed, Hz; None where too few do, or they do not agree."""
    rates = np.array([rate for run in runs if is_clocked(run) and (rate := _rate(run)) is not None])
    if rates.size < FEWEST:
        return None
    usual = float(np.median(rates))
    if np.mean(np.abs(rates / usual - 1) < AGREE) < MOST:
        return None
    tens = 10.0 ** np.floor(np.log10(usual))
    nearest = min((tens * step for step in (*ROUND, 10.0)), key=lambda hz: abs(np.log(hz / usual)))
    return float(nearest if abs(nearest / usual - 1) < NEARLY else usual)


def said_of(clocked: int, others: int, hz: float) -> str:
    """What the seconds of `clocked` runs are, and that `others` have none."""
    rest = f" Of {others} others no seconds are known." if others else ""
    return (
        f"No time column: {clocked} runs declare the speed they turn at, by which their rows come {hz:.4g} times a "
        f"second; that is taken for their time.{rest}"
    )


def slowed(piece: Signals) -> Signals:
    """A piece of a slow measurement without a time, beside others that are clocked: slower than anything matters. What
    depends on its seconds is its own all the same; but at the rate its rows are taken to have it would seem to shake
    what only those others do."""
    usual = float(np.median(np.abs(piece.omega_m)))
    if usual <= SLOW:
        return piece
    by = SLOW / usual
    scaled = {"omega_m": by, "omega_l": by, "torque_rate": by, "alpha_m": by**2, "alpha_l": by**2}
    return replace(piece, **{name: factor * getattr(piece, name) for name, factor in scaled.items()})


def is_clocked(run: Source) -> bool:
    """Whether a run has no time of its own, and says how fast it turned."""
    says = abs(stated(run.conditions, "speed_rpm", 0.0)) > 0 and not stated(run.manifest, "sample_rate_hz", 0.0)
    return says and not run.has("t")  # asked last: it may have to read the column


def _rate(run: Source) -> float | None:
    """By its own speed, of a run that goes one way; None of another."""
    theta = run.column("theta_m")
    if theta is None or theta.size < 2 or not np.isfinite(theta[[0, -1]]).all():
        return None
    gone = abs(float(theta[-1] - theta[0]))
    way = float(np.nansum(np.abs(np.diff(theta[:: max(1, theta.size // SOME)]))))
    if gone < ONE_WAY * way or gone == 0:
        return None
    return (theta.size - 1) * abs(stated(run.conditions, "speed_rpm", 0.0)) * RPM / gone
