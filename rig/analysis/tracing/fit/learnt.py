"""What a fit tells of the gear, as far as columns may lean on it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import INDEX, ORDERS
from rig.analysis.tracing.fit.covariance import scatter
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.thresholds import KNOWN
from rig.core.quantiles import Z95
from rig.model.effect import Known
from rig.model.fourier import FourierSeries

TURNS_ON: Final = 1.0  # N·m, torques that effects turn on are not less
LIGHTEST: Final = 0.1  # of a load's inertia as believed before: what one fit may make of it
ANOTHER: Final = 3.0  # times a declared stiffness or a third of it: what gears differ by is a tenth
LOUD: Final = 10.0  # RMS that the load's equation leaves over the noise: another load hangs there from time to time


def learnt(s: Solution) -> Known:
    """Of the gear, from the coefficients of a fit; what they do not say is as it was before.

    The zero of the torque sensor is what the load's equation has beside inertia and friction. Where parts of unknown
    weight are taken and left it is their mean, and with it the sign of the torque would be lost.
    """
    before = s.design.eq.runs[0].gear
    now = known_of(s.values, before)
    loads = [s.residual(key) for key in s.keys if key[1] == "L"]
    left = float(np.sqrt(np.mean(np.concatenate(loads) ** 2))) if loads else 0.0
    known = left < LOUD * s.design.eq.noise.sigma["L"]
    now = now if known else replace(now, torque_zero=before.torque_zero)
    if _is_another_spring(s, now):
        now = replace(now, K=before.K, B_sp=before.B_sp)
    return now if _weighed(s) else replace(now, J_l=before.J_l)


def _is_another_spring(s: Solution, now: Known) -> bool:
    """Whether a load whose torque nobody read winds up a spring that is far from the declared one: what its inertia
    does not tell of that torque, an arm's weight, does the winding then. Columns that lean on such a spring make the
    next one softer still: from 42 kN·m/rad it went to 0.004 N·m/rad (exam 68, case 37)."""
    said = [run.declared["K"] for run in s.design.eq.runs if run.load_unread and "K" in run.declared]
    return any(not 1 / ANOTHER < now.K / declared < ANOTHER for declared in said)


def _weighed(s: Solution) -> bool:
    """Whether the fit tells the load's inertia better than the manifests do. Where nobody read the load's angle the
    spring and the orders of θ̃_p take its place at speed: it came out up to a quarter too large, once many times, and
    let go of it makes columns of which it comes out larger still. One that nobody declared it may tell to a third."""
    runs = s.design.eq.runs
    if any("theta_l" in run.has for run in runs):
        return True
    if all("J_l" in run.declared for run in runs):
        return False
    at = INDEX["J_l"]
    return bool(KNOWN * abs(s.x[at]) > Z95 * np.sqrt(max(scatter(s)[at, at], 0.0)))


def change(before: Known, now: Known) -> float:
    """Relative, of what effects lean on."""
    a, b = before.kinematic_error, now.kinematic_error
    old = np.array([*a.a, *a.b])
    series = float(np.linalg.norm(old - np.array([*b.a, *b.b])) / max(float(np.linalg.norm(old)), 1e-12))
    rubs = abs(now.tau_cl - before.tau_cl) / TURNS_ON
    return max(series, abs(now.K / before.K - 1), abs(now.J_l / before.J_l - 1), abs(now.J_m / before.J_m - 1), rubs)


def damping_of(coefficient: float, stiffness: float, lag: float) -> float:
    """B_sp [N·m·s/rad] from what stands before ṙ in A, −B_sp/K² + δ/K."""
    return (lag / stiffness - coefficient) * stiffness**2


def known_of(values: Mapping[str, float], before: Known) -> Known:
    """What effects may lean on, from the baseline's coefficients; what they do not say is as it was `before`."""
    stiffness = 1 / values["compliance"] if values["compliance"] > 0 else before.K
    measured = values["compliance"] > 0 and values["damping"] != 0.0
    return Known(
        K=stiffness,
        B_sp=damping_of(values["damping"], stiffness, values["lag"]) if measured else before.B_sp,
        J_m=values["J_m"] if values["J_m"] > 0 else before.J_m,
        J_l=values["J_l"] if values["J_l"] > 0 else max(before.J_l + values["inertia"], LIGHTEST * before.J_l),
        torque_zero=values["tau_l0"],
        tau_c=max(values["tau_c"], 0.0),
        B_m=max(values["B_m"], 0.0),
        tau_cl=max(values["tau_cl"], 0.0),
        B_l=max(values["B_l"], 0.0),
        kinematic_error=FourierSeries(
            tuple(values[f"a{n}"] for n in range(1, ORDERS + 1)), tuple(values[f"b{n}"] for n in range(1, ORDERS + 1))
        ),
    )
