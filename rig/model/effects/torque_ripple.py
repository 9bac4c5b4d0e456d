"""Torque ripple of the motor in proportion to its current."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic
from rig.model.gloss import waved
from rig.model.motor_orders import MOTOR_ORDERS
from rig.model.waves import wave


class TorqueRipple(Effect):
    """The motor gives τ_m·(1 − r·cos(k·θ_m + φ)): what is missing resists it

    A large current turns the motor's field, and φ with it, or saturates its iron: r·cos(k·θ_m + φ) gains a part in
    proportion to τ_m then      [krause2013]

    Cogging is there without current; where the torque hardly changes over the runs the two cannot be told apart.
    """

    name: ClassVar[str] = "torque_ripple"
    in_short: ClassVar[str] = "motor torque ripple in proportion to current"
    glosses: ClassVar[Mapping[str, str]] = {
        **waved("order_{n}", "the motor torque's ripple over the torque, {n} times a motor turn", "{n}·θ_m"),
        **waved("order_{n}_by_torque", "what the ripple of order {n} gains per N·m of motor torque", "{n}·θ_m"),
    }
    source: ClassVar[str] = "ghorbel2001"
    shape_names: ClassVar[tuple[str, ...]] = ("order", "reaction")
    loose: ClassVar[tuple[bool, ...]] = (False, False)
    MOST: Final = 2.0  # rad/(N·m), of the motor's torque
    REACTS: Final = (*range(1, 13), 18, 24, 30, 36)  # orders large enough for the current to change them

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Those of a servo motor."""
        reacts = [(float(k), 1.0) for k in self.REACTS]
        return (*((float(k), 0.0) for k in MOTOR_ORDERS), *reacts)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """τ_m times cosine and sine, and τ_m² times them."""
        x, kept = shape[0] * signals.theta_m, signals.kept(shape[0], signals.omega_m) * signals.tau_m
        waves = wave(x, kept)
        return {Port.MOTOR_TORQUE: np.hstack([waves, waves * signals.tau_m[:, None]]) if shape[1] else waves}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Relative amplitude and phase; of what grows with the torque too."""
        name = f"order_{fit.shape[0]:g}"
        more = harmonic(fit, f"{name}_by_torque", "1/(N·m)", first=2) if fit.shape[1] else ()
        return (*harmonic(fit, name, "1"), *more)

    def plausible(self, fit: Fit) -> bool:
        """No field is turned by more than MOST: what has hardly a ripple without torque is something else."""
        if not fit.shape[1]:
            return True
        return bool(np.hypot(*fit.coefficients[2:]) < self.MOST * np.hypot(*fit.coefficients[:2]))
