"""A run at constant torque: θ̃ at speed over the settled part, with the torque that held it and how steady it was."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.collected import Findings
from rig.analysis.findings.result import Array, Check
from rig.analysis.motion.source import Motion, Source
from rig.analysis.motion.window import Window, measured_window, part
from rig.analysis.sensors.standstill import floor_of
from rig.analysis.turning.run import add_turning

CONSTANT = 0.005  # of the torque: what "constant" means, one part in 200
ENOUGH = 60  # turns of the wave generator that a run at constant torque should have


def add_constant_torque(found: Findings, run: Source, motion: Motion) -> None:
    """Add what the settled part says. The speeds of a run-up are no drift and are left out."""
    window = measured_window(run, motion)
    settled = part(motion, window.lo, window.hi)
    _constancy(found, window)
    add_turning(found, run, settled, None, slow=False)
    _torques(found, run, settled, window)
    turns = abs(float(settled.theta_m[-1] - settled.theta_m[0])) / (2 * np.pi)
    if run.procedure == "constant_torque" and turns < ENOUGH - 0.5:
        found.cannot.append(f"The settled part has {turns:.0f} turns, {ENOUGH} are usual: intervals are the wider.")


def _constancy(found: Findings, window: Window) -> None:
    if not np.isfinite(window.torque):
        found.cannot.append("No commanded torque was recorded: that it was constant is taken on trust.")
        return
    share = window.spread / abs(window.torque) if window.torque else float("inf")
    found.checks.append(
        Check(
            "torque_constant",
            bool(share <= CONSTANT),
            f"The commanded torque {window.torque:.4f} N·m varied by {100 * share:.2g} % over {window.how}, "
            f"limit {100 * CONSTANT:g} %.",
        )
    )


def _torques(found: Findings, run: Source, settled: Motion, window: Window) -> None:
    """Mean torques of both sides over the settled part, and how far the shaft torque swings."""
    where = f"over {window.how}"
    tau_m, tau_l = settled.pick(run.column("tau_m")), settled.pick(run.column("tau_l"))
    if tau_m is not None and _usable(tau_m):
        floor = floor_of(tau_m, settled.t)
        how = f"Mean of what the drive reports {where}; interval from the scatter of twenty pieces."
        found.figure("mean_motor_torque", "Mean motor torque", floor.mean, "N·m", floor.u_mean, how)
    if tau_l is not None and _usable(tau_l):
        floor = floor_of(tau_l, settled.t)
        how = f"Mean of the torque sensor {where}, its zero not taken off; interval from the scatter of twenty pieces."
        found.figure("mean_shaft_torque", "Mean shaft torque", floor.mean, "N·m", floor.u_mean, how)
        found.cannot.append("The torque sensor's zero is in the mean shaft torque: no part of this run shows it alone.")
        low, high = np.percentile(tau_l, [0.5, 99.5])
        how = f"From the 0.5 to the 99.5 percentile of single rows {where}: noise of the sensor is in it."
        found.exact("shaft_torque_swing", "Shaft torque, swing", float(high - low), "N·m", how)


def _usable(tau: Array) -> bool:
    return tau.size >= 200 and bool(np.isfinite(tau).all())
