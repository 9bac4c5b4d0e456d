"""θ̃ at speed less the pure kinematic error of a slow run: what the gear's flexibility added, order by order."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.kinematic_error.measure import KinematicError, groups_by_speed, measure
from rig.analysis.kinematic_error.profile import Profile, phasors, u_phasors
from rig.analysis.motion.declared import declared_gear
from rig.analysis.motion.source import Motion, Source
from rig.analysis.motion.strokes import find_strokes
from rig.analysis.orders.align import Alignment, Complex, align
from rig.core.units import RPM
from rig.model.linear import transmissibility


@dataclass(frozen=True)
class Decomposition:
    """θ̃ = θ̃_p + θ̃_s, orders 1..k as Re Σ z_n·exp(jnθ), arcsec at the output      [ghorbel2001, Eq. 2]"""

    total: Complex  # (k,) θ̃ at speed
    pure: Complex  # (k,) θ̃_p of the slow run, turned to the angle zero of the run at speed
    u: Array  # (k,) 1 σ of one part of total − pure
    factor: float  # what one σ is multiplied by for 95 %
    ratio: Complex | None  # (k,) linear θ̃_n/θ̃_p,n at this speed; None: the inertias or the stiffness are not declared
    u_ratio: Array | None  # (k,) 1 σ of it from the wander of the speed alone
    alignment: Alignment

    @property
    def flexible(self) -> Complex:
        """θ̃_s = θ̃ − θ̃_p, (k,)."""
        return self.total - self.pure

    @property
    def predicted(self) -> Complex | None:
        """(T_n − 1)·θ̃_p,n, (k,)."""
        return None if self.ratio is None else (self.ratio - 1.0) * self.pure


def slow_profile(reference: Source, motion: Motion) -> KinematicError | None:
    """The pure kinematic error of a reference run; None when it has none."""
    if motion.theta_l is None or not (strokes := find_strokes(motion)):
        return None
    groups = groups_by_speed(motion, strokes)
    most = max(sum(s.revolutions for s in g) for g in groups)
    return measure(reference, motion, next(g for g in groups if sum(s.revolutions for s in g) * 4 >= most), slow=True)


def decompose(run: Source, fast: KinematicError, slow: Profile) -> Decomposition | None:
    """Subtract `slow` from `fast`, angle on angle. None when nothing stands out of the noise to align them by.

    The zero of the motor angle is taken for common where the fitted shift is small (see `align`); else the fitted shift
    is used and its uncertainty carried along.
    """
    k = min(fast.profile.terms, slow.terms)
    total, pure = phasors(fast.profile, k), phasors(slow, k)
    ratio = ratios(run, fast, k)
    ratio_u = None if ratio is None else ratio[1]
    expected = pure * (1.0 if ratio is None else ratio[0])
    u_fast, u_slow = u_phasors(fast.profile, k), u_phasors(slow, k)
    alignment = align(total, expected, np.hypot(u_fast, u_slow), trusted=k if ratio is not None else 2)
    if alignment is None:
        return None
    n = np.arange(1.0, k + 1)
    turned = pure * np.exp(-1j * n * alignment.shift)
    u = np.sqrt(u_fast**2 + u_slow**2 + (n * alignment.u * np.abs(pure)) ** 2)
    factor = max(fast.profile.factor, slow.factor)
    return Decomposition(total, turned, u, factor, None if ratio is None else ratio[0], ratio_u, alignment)


def ratios(run: Source, fast: KinematicError, k: int) -> tuple[Complex, Array] | None:
    """(θ̃_n/θ̃_p,n, 1 σ of it from the wander of the speed), both (k,): the linear model's at the run's own speeds.

    The mean over the turns' own speeds: near a resonance the speed of a run at constant torque wanders across it.
    """
    gear = declared_gear(run)
    speeds = np.concatenate([s.speed_rpm for s in fast.strokes]) * RPM
    if gear is None or not np.isfinite(speeds).all():
        return None
    n = np.arange(1.0, k + 1)
    each = np.array([transmissibility(gear, n, float(omega)) for omega in speeds])
    return each.mean(axis=0), np.abs(each - each.mean(axis=0)).std(axis=0) / np.sqrt(max(speeds.size - 1, 1))
