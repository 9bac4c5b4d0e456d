"""Do all slow runs count the motor angle from one zero? An encoder that was switched off in between has another one.

Fitted together such runs leave waves of the motor's angle that nothing explains: what is told of them then names the
order, and not the cause. Runs that are never slow do not show their zero, for inertia turns the phase of their error.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from rig.analysis.findings.collected import pm
from rig.analysis.orders.align import Complex, other_zero, turned
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.runs.told_once import Said
from rig.core.quantiles import Z95
from rig.core.units import DEG, RPM, TURN
from rig.model.effect import Array

ORDERS: Final = 8
SLOW: Final = 25.0 * RPM  # rad/s
SEEN: Final = 2.0  # turns at least
ROWS: Final = 6000  # of a run: an order needs no more, and they are nearly independent
OTHERS: Final = 0.5  # of what they differ by in all orders but one: any difference of one order alone is a shift of it


class Waves(NamedTuple):
    """Phasors of the orders (k,), rad at the output, and their standard deviations."""

    of: Complex
    u: Array


def other_zeros(runs: Sequence[Recording]) -> list[Said]:
    """Of each slow run that counts from another zero than the first of them, by how far."""
    slow = [(run, waves) for run in runs if (waves := _waves(run)) is not None]
    out = []
    for run, waves in slow[1:]:
        first, reference = slow[0]
        if apart := _apart(waves, reference):
            said = (
                f"it counts the motor angle from another zero than {first.name}, by {apart}, as after switching the "
                "encoder off; waves that this leaves are no effect: trace the runs of one zero at a time"
            )
            out.append(Said(run.name, "", said))
    return out


def _waves(run: Recording) -> Waves | None:
    """Of a run whose output is free, both of whose angles were read, and whose motor turned slowly; None else."""
    if run.locked or not {"theta_m", "theta_l"} <= run.has or not 0 < run.turning < SLOW:
        return None
    theta = np.concatenate([p.theta_m for p in run.pieces])
    if np.ptp(theta) < SEEN * TURN:
        return None
    step = max(1, theta.size // ROWS)
    theta = theta[::step]
    error = theta / run.ratio - np.concatenate([p.theta_l for p in run.pieces])[::step]
    torque = np.concatenate([p.torque for p in run.pieces])[::step]
    angle = np.multiply.outer(theta, np.arange(1, ORDERS + 1))
    beside = [np.ones(theta.size), theta - theta.mean(), *([torque] if np.isfinite(torque).all() else [])]
    z = np.hstack([np.cos(angle), np.sin(angle), np.stack(beside, 1)])
    good = np.isfinite(z).all(1) & np.isfinite(error)
    z, error = z[good], error[good] - error[good].mean()
    if error.size < 4 * z.shape[1]:
        return None
    x = np.linalg.lstsq(z, error, rcond=None)[0]
    u = float(np.std(error - z @ x)) * np.sqrt(2.0 / error.size)
    return Waves(x[:ORDERS] - 1j * x[ORDERS : 2 * ORDERS], np.full(ORDERS, u))


def _apart(one: Waves, reference: Waves) -> str:
    """By how far the zero of `one` is from the other's, in words; "" where it is not, or something else differs too."""
    where = other_zero(one.of, reference.of, np.hypot(one.u, reference.u))
    if where is None:
        return ""
    before, after = np.abs(one.of - reference.of), np.abs(one.of - turned(reference.of, where.shift))
    rest = np.arange(ORDERS) != int(np.argmax(before))
    gone = np.linalg.norm(after[rest]) < OTHERS * np.linalg.norm(before[rest])
    return pm(where.fitted / DEG, Z95 * where.u_fitted / DEG, "degrees") if gone else ""
