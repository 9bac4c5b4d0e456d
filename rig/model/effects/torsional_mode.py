"""A second resonance: something elastic beyond the gear's own spring."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter
from rig.model.second_mode import coupling, output
from rig.model.second_mode.ordered import shaking
from rig.model.second_mode.shaken import EXCITED, shaken
from rig.model.second_mode.swung import swung

LOAD, MOTOR = 0.0, 1.0  # of the first shape parameter: what the extra inertia hangs on
STIFF = 2.0  # or a coupling that is told by its twist alone
COUPLING = 3.0  # or one with its inertia, its damper and friction on either side of it
HUB = 4.0  # or an inertia between the gear and the spring of the torque sensor
DRIVEN = 6.0  # the inertia on the load once more, its swing told by the torque
FLANGE = 7.0  # or an inertia behind the torque sensor, before the shaft that bears the load
COUPLINGS = (STIFF, COUPLING)


class TorsionalMode(Effect):
    """An inertia J_2 hangs on the load (or the motor) by a spring of its own, with a damper beside it: it resists with
    J_2·H·ω̇, H = (2ζωs + ω²)/(s² + 2ζωs + ω²). Far below ω it is just more inertia, which the baseline already has.

    The spring of a coupling between the motor's encoder and the wave generator twists as well, by ψ = τ/k under the
    τ that goes through it, T·(1/N − θ̃_p′) at least: the gear stands at θ_m − ψ, so θ̃ gains (1/N − θ̃_p′)·ψ and
    the lever is that of the other angle. How the wave generator turns tells what its inertia J_2 and its friction add,
    and the load tells how it turns: `coupling.sprung`.

    Where the load itself hardly moves because J_2 swings against it, ω̇ is encoder noise, and that is what H is largest
    at. The torque that drives both tells the same: J_l·ω̇ = T + (1/ω² − 1/ω_p²)·s²·H_p·T, H_p being the two inertias
    against each other, ω_p² = ω²·J_l/(J_l − J_2), J_l both of them.

    A hub before the torque sensor is turned by the gear and not by what the sensor reads: the gear carries
    J_2·(ω̇_l + T̈/k) more, k being the sensor's spring. A flange behind it, with a shaft that bears the load, twists that
    and lets the load swing: `output.flange`.
    """

    name: ClassVar[str] = "torsional_mode"
    in_short: ClassVar[str] = "a second resonance beyond the gear's own"
    glosses: ClassVar[Mapping[str, str]] = {
        "J_2": "inertia on a spring of its own",
        "frequency": "frequency at which that spring and inertia resonate",
        "hub_frequency": "frequency at which a hub of that inertia resonates on the torque sensor's spring",
        "zeta": "ζ, damping ratio of that resonance",
        "shaft_compliance": "1/k, compliance of the shaft behind the flange",
        "coupling_compliance": "1/k, compliance of the coupling between motor and wave generator",
    }
    source: ClassVar[str] = "ghorbel2001"
    needs: ClassVar[frozenset[str]] = frozenset({"t"})
    shape_names: ClassVar[tuple[str, ...]] = ("side", "frequency", "zeta", "about")  # about: rad/(N·m), of a coupling
    loose: ClassVar[tuple[bool, ...]] = (False, True, True, False)
    LOWEST: Final = 10.0  # Hz
    STEP: Final = 1.08  # neighbouring frequencies within a half width of a 4 % damped peak
    ZETA: Final = 0.04
    SOFTEST: Final = 1.0  # rad/(N·m): a coupling that twists by a turn at 6 N·m is none
    PEAK: Final = 0.15  # of a frequency, half its 95 % interval: of true ones it is a fiftieth
    FURTHEST: Final = 1.6  # of the band: a flange shows below its resonance as well
    OTHERS: Final = 0.75  # of that: how far the other modes go
    AT_THE_END: Final = 0.96  # of the frequencies that are fitted: there it is none that was found
    LIGHTEST: Final = 0.14  # of all that turns, what is left on a motor: its rotor at least
    SHARE: Final = 1.5  # of the friction, on one side of a coupling: of it and of its viscous part, both being fitted
    APART: Final = 3.0  # times: how far the two a flange tells its frequency by may differ, as 1/ω² and as a peak

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Frequencies up to what the equations are compared at. A slow motor shakes nothing but where it turns back,
        and there friction does all kinds of things."""
        if reach.fastest < EXCITED:
            return ()
        count = int(np.log(max(reach.band, self.LOWEST) / self.LOWEST) / np.log(self.STEP)) + 1
        frequencies = self.LOWEST * self.STEP ** np.arange(count)
        modes = tuple((side, float(f), self.ZETA, 0.0) for side in (LOAD, MOTOR, DRIVEN) for f in frequencies)
        flange = tuple((FLANGE, float(f), self.ZETA, 0.0) for f in frequencies[::2])
        top = float(max(reach.band, self.LOWEST))
        known = COUPLINGS if "tau_m" in reach.has else (STIFF,)  # else of the friction beyond it nothing is
        return (*modes, *flange, *((side, top, self.ZETA, 0.0) for side in (*known, HUB)))

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """Any frequency that is compared; damping of steel to rubber."""
        return ((LOAD, FLANGE), (0.7 * self.LOWEST, self.FURTHEST * reach.band), (0.002, 0.4), (0.0, self.SOFTEST))

    def expands(self, shape: Shape) -> bool:
        """About the twist of a coupling."""
        return shape[0] in COUPLINGS

    def about(self, shape: Shape, coefficients: Array) -> Shape:
        """The compliance as found."""
        return (*shape[:3], float(np.clip(coefficients[0], 0.0, self.SOFTEST)))

    def beyond(self, shape: Shape, reach: Reach) -> bool:
        """A mode that the fit pushed out of the band, or down to where none is looked for, or damped until it was no
        peak; a coupling and a hub need none inside."""
        low, high = self.bounds(reach)[1]
        if shape[0] not in (LOAD, MOTOR, DRIVEN, FLANGE):
            return False
        flat = shape[2] > self.AT_THE_END * self.bounds(reach)[2][1]
        end = high if shape[0] == FLANGE else self.OTHERS * high
        return flat or shape[1] > self.AT_THE_END * end or shape[1] * self.AT_THE_END < low

    def is_scaled(self, scale: Parameter, reach: Reach) -> bool:
        """A resonance is a peak: where its frequency is known no better than that, something else has been fitted."""
        return scale.ci95[1] - scale.ci95[0] < 2 * self.PEAK * abs(scale.value)

    def swings(self, shape: Shape) -> tuple[float, float] | None:
        """Of all but a coupling and a hub, whose columns do not."""
        side, frequency, zeta, _ = shape
        return (2.0 * np.pi * frequency, zeta) if side in (LOAD, MOTOR, DRIVEN, FLANGE) else None

    def holds(self, shape: Shape) -> bool:
        """A coupling with all that it has: the encoder's noise takes some of the inertia on it from the motor's torque,
        which a second mode would give back."""
        return shape[0] == COUPLING

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column: the acceleration behind the spring, or the twist of a coupling for 1 rad/(N·m); of one with all
        that it has six; of a hub two, for J_2 and for J_2/k; of a flange three, for 1/k, J_2/k and 1/ω²."""
        side, frequency, zeta, about = shape
        omega = 2.0 * np.pi * frequency
        if side == HUB:
            return output.hub(signals)
        if side == FLANGE:
            return output.flange(signals, omega, zeta)
        if side == COUPLING:
            return coupling.sprung(signals, about)
        if side == STIFF:
            return coupling.stiff(signals, about)

        def swinging(whole: Signals) -> tuple[Array, ...]:
            if side == DRIVEN:
                torque = shaking(whole, "tau_l", np.nan_to_num(whole.tau_l), frequency)
                return (shaken(whole, -swung(whole, torque, omega, zeta)[1]),)
            name = "alpha_m" if side == MOTOR else "alpha_l"
            alpha = shaking(whole, name, getattr(whole, name), frequency)
            return (shaken(whole, alpha - swung(whole, alpha, omega, zeta)[1] / omega**2),)  # H·ω̇

        port = Port.MOTOR_TORQUE if side == MOTOR else Port.LOAD_TORQUE
        return {port: signals.states(swinging, side, frequency, zeta)[0][:, None]}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Inertia, frequency and damping; of a coupling its compliance, of a hub no damping."""
        by = np.eye(fit.covariance.shape[0])
        by_frequency, by_zeta = by[fit.coefficients.size + 1], by[fit.coefficients.size + 2]
        if fit.shape[0] == HUB:
            return self._of_hub(fit, by)
        if fit.shape[0] == DRIVEN:
            return self._driven(fit, by[0], by_frequency, by_zeta)
        mode = (
            parameter("frequency", fit.shape[1], fit.half_width(by_frequency), "Hz"),
            parameter("zeta", fit.shape[2], fit.half_width(by_zeta), "1"),
        )
        if fit.shape[0] == FLANGE:
            return (parameter("shaft_compliance", fit.coefficients[0], fit.half_width(by[0]), "rad/(N·m)"), *mode)
        if fit.shape[0] in (LOAD, MOTOR):
            return (parameter("J_2", fit.coefficients[0], fit.half_width(by[0]), "kg·m²"), *mode)
        compliance = parameter("coupling_compliance", fit.coefficients[0], fit.half_width(by[0]), "rad/(N·m)")
        return (compliance, *(self._on_it(fit, by) if fit.shape[0] == COUPLING else ()))

    def _driven(self, fit: Fit, by: Array, by_frequency: Array, by_zeta: Array) -> tuple[Parameter, ...]:
        """Of J_2 on its own spring, from how both inertias swing against each other."""
        both, c = 2.0 * np.pi * fit.shape[1], max(fit.coefficients[0], 0.0)
        x = c * both**2  # ω_p²/ω² − 1
        slowed = 1.0 / np.sqrt(1.0 + x)  # ω/ω_p
        by_x = both**2 * by + 2.0 * x / fit.shape[1] * by_frequency
        frequency, zeta = fit.shape[1] * slowed, fit.shape[2] * slowed
        return (
            parameter("J_2", fit.known.J_l * x * slowed**2, fit.half_width(fit.known.J_l * slowed**4 * by_x), "kg·m²"),
            parameter(
                "frequency", frequency, fit.half_width(slowed * by_frequency - frequency / 2 * slowed**2 * by_x), "Hz"
            ),
            parameter("zeta", zeta, fit.half_width(slowed * by_zeta - zeta / 2 * slowed**2 * by_x), "1"),
        )

    def _on_it(self, fit: Fit, by: Array) -> tuple[Parameter, ...]:
        """Of the wave generator on its coupling, where the kinematic error tells: what the motor's torque says of J_2
        is less, as it answers the rounding of the encoder as well."""
        by_k, square = fit.coefficients[:2]
        if not fit.half_width(by[1]) < 2.0 * self.PEAK * square:
            return ()
        inertia, frequency = square / by_k, 1.0 / (2.0 * np.pi * np.sqrt(square))
        along = (by[1] - inertia * by[0]) / by_k
        return (
            parameter("J_2", inertia, fit.half_width(along), "kg·m²"),
            parameter("frequency", frequency, fit.half_width(by[1] * frequency / (2.0 * square)), "Hz"),
        )

    def _rubs(self, fit: Fit) -> bool:
        """Whether no more friction is on the wave generator's side of its coupling than there is: by as much as its
        viscous one twists it a motor's angle that is read late differs as well."""
        both = self.SHARE * fit.coefficients[0]
        return bool(abs(fit.coefficients[3]) < both and abs(fit.coefficients[4]) < both * fit.known.B_m)

    def _of_hub(self, fit: Fit, by: Array) -> tuple[Parameter, ...]:
        """Without a frequency where 1/ω² may as well be nothing: the hub is stiff, as far as can be told. It is no peak
        that has to be seen: far below it the hub's inertia shows as well."""
        share, square = fit.coefficients[:2]
        # K is that of gear and sensor in series, and the gear alone gives by J_2/K_gear: J_2 = share + K/ω²
        inertia, along = share + fit.known.K * max(square, 0.0), by[0] + fit.known.K * by[1]
        turned = (parameter("J_2", inertia, fit.half_width(along), "kg·m²"),)
        if self._is_stiff(fit):
            return turned
        frequency = 1.0 / (2.0 * np.pi * np.sqrt(square))
        half = fit.half_width(by[1] * frequency / (2.0 * square))
        return (*turned, parameter("hub_frequency", frequency, half, "Hz"))

    def softens(self, fit: Fit) -> tuple[float, Array]:
        """The torque sensor's spring behind a hub, 1/k = (1/ω²)/J_2, where it is told."""
        by = np.zeros(fit.coefficients.size)
        if fit.shape[0] != HUB or self._is_stiff(fit):
            return 0.0, by
        share, square = fit.coefficients[:2]
        inertia = share + fit.known.K * square
        by[:2] = -square / inertia**2, share / inertia**2
        return float(square / inertia), by

    def _is_stiff(self, fit: Fit) -> bool:
        """Whether the 1/ω² of a hub may as well be nothing."""
        return bool(fit.coefficients[1] <= fit.half_width(np.eye(len(fit.covariance))[1]))

    def plausible(self, fit: Fit) -> bool:
        """An inertia is positive, and so is a compliance; of a hub's and a coupling's none that is beyond all that is
        compared; a flange slows the load as its frequency says; a motor has a rotor of its own."""
        inertia, *others = fit.coefficients[:2]
        if fit.shape[0] == FLANGE:
            told = fit.coefficients[2] * (2.0 * np.pi * fit.shape[1]) ** 2
            return bool(min(fit.coefficients[:2]) > 0 and 1.0 / self.APART < told < self.APART)
        if fit.shape[0] == COUPLING and not self._rubs(fit):
            return False
        if fit.shape[0] in (HUB, COUPLING):
            return bool(inertia > 0 and others[0] > -1.0 / (2.0 * np.pi * fit.shape[1]) ** 2)
        if fit.shape[0] == MOTOR and fit.known.J_m < self.LIGHTEST * (fit.known.J_m + inertia):
            return False  # lines of an encoder in runs that turn steadily: nothing accelerates, and they tell J_m
        return bool(inertia > 0 and all(x > 0 for x in others))
