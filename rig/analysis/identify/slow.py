"""Slow runs: Fourier coefficients of the kinematic error with their uncertainty, as rows of the spring's equation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.identify.gram import Known, known
from rig.analysis.identify.recording import Recording
from rig.analysis.kinematic_error.measure import groups_by_speed
from rig.analysis.kinematic_error.profile import combine
from rig.analysis.motion.strokes import find_strokes
from rig.analysis.orders.revolutions import analyse_stroke
from rig.core.units import ARCSEC, RPM

SLOW = 25.0  # rpm: above, inertia bends the gear by more than the correction for it is worth


@dataclass(frozen=True)
class SlowSeries:
    """(a_1..a_k, b_1..b_k) of θ̃ in one slow run, rad, with 1 σ each, at `omega` rad/s of the motor."""

    run: str
    coefficients: Array
    u: Array
    dof: float
    omega: float
    tau_ext: float


def slow_series(run: Recording, terms: int) -> SlowSeries | None:
    """None unless the run turned slowly, unloaded, for at least two revolutions."""
    if run.locked or run.tau_ext != 0.0:
        return None
    groups = groups_by_speed(run.motion, find_strokes(run.motion))
    if not groups or sum(s.revolutions for s in groups[0]) < 2:
        return None
    if min(int(np.min(np.diff(s.edges))) for s in groups[0]) < 8 * terms:
        return None
    results = [analyse_stroke(run.motion, s, terms) for s in groups[0]]
    omega = float(np.mean(np.abs(np.concatenate([r.speed_rpm for r in results])))) * RPM
    if not omega / RPM < SLOW:
        return None
    profile = combine(results, np.zeros(terms))
    c = np.concatenate((profile.cosine, profile.sine)) * ARCSEC
    u = np.concatenate((profile.u_cosine, profile.u_sine)) * ARCSEC
    if not np.isfinite(u).all():
        return None
    return SlowSeries(run.name, c, u, profile.dof, omega, run.tau_ext)


def slow_rows(slow: SlowSeries, terms: int, size: int, K: float, J_l: float) -> Known:
    """θ̃_n = θ̃_p,n·(1 + s_n), s_n = (nΩ)²·J_l/K as long as it is small      [ghorbel2001, Eq. 7]"""
    n = np.tile(np.arange(1.0, terms + 1), 2)
    added = np.minimum((n * slow.omega) ** 2 * (J_l / K), 0.2) if K > 0 and J_l > 0 else np.zeros(2 * terms)
    X = np.zeros((2 * terms, size))
    X[np.arange(2 * terms), np.arange(2 * terms)] = 1.0 + added
    spread = (slow.dof / (slow.dof - 2.0)) if slow.dof > 2.5 else 5.0  # Student's variance: few revolutions weigh less
    return known(slow.run, X, slow.coefficients, np.maximum(slow.u, 1e-12) ** 2 * spread)
