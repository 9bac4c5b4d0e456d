"""The housing gives way to the reaction of the output torque, and both encoders turn with it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter
from rig.model.second_mode.ordered import shaking
from rig.model.second_mode.shaken import shaken
from rig.model.second_mode.swung import swung

ON_HOUSING, ON_GROUND = 0.0, 1.0  # of the first shape parameter: where the encoders are held


class SupportCompliance(Effect):
    """The housing turns back by T/K_s·H, H = ω²/(s² + 2ζωs + ω²): both angles read so much too much when the encoders
    ride on it; held on the ground they read right, and the gear seems so much softer.

    Far below ω, and so in slow runs, it is just more or less compliance, which the fitted K already has: of encoders on
    the ground the column is (H − 1)·T, what the torque sensor reads too much is wound up by all of it, and the gear's
    own K is told without it.
    """

    name: ClassVar[str] = "support_compliance"
    in_short: ClassVar[str] = "the housing moves"
    glosses: ClassVar[Mapping[str, str]] = {
        "compliance": "1/K_s, how far the housing turns under the torque",
        "frequency": "frequency at which the housing resonates",
        "zeta": "ζ, damping ratio of that resonance",
    }
    source: ClassVar[str] = "ghorbel2001"
    needs: ClassVar[frozenset[str]] = frozenset({"t"})
    shape_names: ClassVar[tuple[str, ...]] = ("held", "frequency", "zeta")
    loose: ClassVar[tuple[bool, ...]] = (False, True, True)
    modes_apart: ClassVar[float] = 1.3  # a housing rocks and twists, each at a frequency of its own
    LOWEST: Final = 8.0  # Hz
    FEW_BELOW: Final = 15.0  # Hz: every second one, for few housings are so soft
    STEP: Final = 1.1  # neighbouring frequencies within a half width of a 5 % damped peak
    ZETA: Final = 0.05
    DAMPED: Final = 0.35  # four fits of the blind test had 0.01 to 0.16, one that drew what another law has wrong 0.45

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Frequencies up to what the equations are compared at."""
        count = int(np.log(max(reach.band, self.LOWEST) / self.LOWEST) / np.log(self.STEP)) + 1
        frequencies = self.LOWEST * self.STEP ** np.arange(count)
        frequencies = frequencies[(frequencies > self.FEW_BELOW) | (np.arange(count) % 2 == 0)]
        return tuple((held, float(f), self.ZETA) for held in (ON_HOUSING, ON_GROUND) for f in frequencies)

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """Any frequency that is compared; damping of steel to rubber."""
        return ((ON_HOUSING, ON_GROUND), (0.7 * self.LOWEST, 1.2 * reach.band), (0.005, 0.5))

    def beyond(self, shape: Shape, reach: Reach) -> bool:
        """A mode that the fit pushed out of the band, or damped until it swings no more."""
        return shape[1] > 1.15 * reach.band or shape[2] > self.DAMPED

    def has_state(self) -> bool:
        """It swings."""
        return True

    def swings(self, shape: Shape) -> tuple[float, float] | None:
        """The housing."""
        return 2.0 * np.pi * shape[1], shape[2]

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column, in both readings or, beyond 1/K, in the wind-up."""
        held, frequency, zeta = shape
        torque = signals.once(self.name, lambda: np.ascontiguousarray(np.nan_to_num(signals.torque)))
        shakes = shaking(signals, "torque", torque, frequency)
        after, _ = swung(signals, shakes, 2.0 * np.pi * frequency, zeta)
        beyond = shaken(signals, after - shakes)[:, None]
        if held == ON_GROUND:
            return {Port.WIND_UP: beyond}
        moved = torque[:, None] + beyond
        return {Port.READS_THETA_L: moved, Port.READS_THETA_M: moved}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Compliance of the support, its frequency and damping."""
        compliance, frequency, zeta = np.eye(4)[[0, 2, 3], : fit.covariance.shape[0]]
        return (
            parameter("compliance", fit.coefficients[0], fit.half_width(compliance), "rad/(N·m)"),
            parameter("frequency", fit.shape[1], fit.half_width(frequency), "Hz"),
            parameter("zeta", fit.shape[2], fit.half_width(zeta), "1"),
        )

    def plausible(self, fit: Fit) -> bool:
        """It gives way to a torque."""
        return bool(fit.coefficients[0] > 0)

    def softens(self, fit: Fit) -> tuple[float, Array]:
        """The support's, where encoders on the ground see it."""
        seen = 1.0 if fit.shape and fit.shape[0] == ON_GROUND else 0.0
        return seen * float(fit.coefficients[0]), np.array([seen])


class StiffSupport(SupportCompliance):
    """The same far below any resonance, which nothing shows: with encoders on the housing it is compliance alone. In a
    gear that turns the baseline's K has it; a locked output's own angle shows it apart."""

    shape_names: ClassVar[tuple[str, ...]] = ()
    loose: ClassVar[tuple[bool, ...]] = ()

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One."""
        return ((),)

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """Nothing is loose."""
        return ()

    def beyond(self, shape: Shape, reach: Reach) -> bool:
        """There is no mode."""
        return False

    def has_state(self) -> bool:
        """It follows the torque."""
        return False

    def swings(self, shape: Shape) -> tuple[float, float] | None:
        """It does not."""
        return None

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column, in both readings."""
        moved = np.nan_to_num(signals.torque)[:, None]
        return {Port.READS_THETA_L: moved, Port.READS_THETA_M: moved}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Compliance of the support."""
        compliance = np.eye(1, fit.covariance.shape[0])[0]
        return (parameter("compliance", fit.coefficients[0], fit.half_width(compliance), "rad/(N·m)"),)
