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

    A large current turns the motor's field, and φ with it: r·cos(k·θ_m + φ) gains a part in proportion to τ_m then; or
    it saturates the iron, whichever its way, and the part is in proportion to |τ_m|      [krause2013]

    What the rotor's shape makes of the current keeps its phase when the current turns round: |τ_m|·r·cos(k·θ_m + φ).

    Cogging is there without current; where the torque hardly changes over the runs the two cannot be told apart.
    """

    name: ClassVar[str] = "torque_ripple"
    in_short: ClassVar[str] = "motor torque ripple in proportion to current"
    glosses: ClassVar[Mapping[str, str]] = {
        **waved("order_{n}", "the motor torque's ripple over the torque, {n} times a motor turn", "{n}·θ_m"),
        **waved("order_{n}_by_torque", "what the ripple of order {n} gains per N·m of motor torque", "{n}·θ_m"),
        **waved("order_{n}_saturating", "what the ripple of order {n} gains per N·m of the torque's size", "{n}·θ_m"),
        **waved(
            "order_{n}_by_size", "the ripple over the motor torque's size, whichever its way, {n} times", "{n}·θ_m"
        ),
    }
    source: ClassVar[str] = "ghorbel2001"
    shape_names: ClassVar[tuple[str, ...]] = ("order", "reaction")
    comes_round: ClassVar[bool] = True
    loose: ClassVar[tuple[bool, ...]] = (False, False)
    MOST: Final = 2.0  # rad/(N·m), of the motor's torque
    REACTS: Final = (*range(1, 13), 18, 24, 30, 36)  # orders large enough for the current to change them
    # `reaction`: in proportion to τ_m, a part of it to τ_m², in proportion to |τ_m|, or a part of it to τ_m·|τ_m|
    WITH_IT, REACTING, BY_SIZE, SATURATING = 0.0, 1.0, 2.0, 3.0

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Those of a servo motor."""
        reacts = [(float(k), law) for law in (self.REACTING, self.BY_SIZE, self.SATURATING) for k in self.REACTS]
        return (*((float(k), self.WITH_IT) for k in MOTOR_ORDERS), *reacts)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """τ_m or its size times cosine and sine; τ_m² or τ_m·|τ_m| times them."""
        order, law = shape
        torque = np.abs(signals.tau_m) if law == self.BY_SIZE else signals.tau_m
        waves = wave(order * signals.theta_m, signals.kept(order, signals.omega_m) * torque)
        if law not in (self.REACTING, self.SATURATING):
            return {Port.MOTOR_TORQUE: waves}
        by = signals.tau_m if law == self.REACTING else np.abs(signals.tau_m)
        return {Port.MOTOR_TORQUE: np.hstack([waves, waves * by[:, None]])}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Relative amplitude and phase; of what grows with the torque too."""
        order, law = fit.shape
        name = f"order_{order:g}"
        if law == self.BY_SIZE:
            return harmonic(fit, f"{name}_by_size", "1")
        if law == self.WITH_IT:
            return harmonic(fit, name, "1")
        more = f"{name}_by_torque" if law == self.REACTING else f"{name}_saturating"
        return (*harmonic(fit, name, "1"), *harmonic(fit, more, "1/(N·m)", first=2))

    def plausible(self, fit: Fit) -> bool:
        """No field is turned by more than MOST: what has hardly a ripple without torque is something else."""
        if fit.shape[1] not in (self.REACTING, self.SATURATING):
            return True
        return bool(np.hypot(*fit.coefficients[2:]) < self.MOST * np.hypot(*fit.coefficients[:2]))
