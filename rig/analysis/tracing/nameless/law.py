"""What laws without a name have in common, and what several of them are made of."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final, NamedTuple

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic
from rig.model.waves import wave

LONG: Final = 1e3  # s, about a campaign
FAST: Final = 40.0  # rad/s of the motor, about its fastest run
SEVERAL: Final = 6  # runs, with fewer a drift is whatever one of them has
WIDE: Final = 2.0  # fastest over slowest
BOTH_ANGLES: Final = frozenset({"theta_m", "theta_l"})
"""What a law that is made of the torque read needs, to be held against a wind-up that is read as well: by the torque
sensor alone it would foretell that reading by itself, and as few as six columns then foretell anything."""
LARGEST: Final = (2, 4)  # orders of the motor: two lobes and their square make most of every kinematic error


class Amount(NamedTuple):
    """How much it is: what the number says, and the number with half its 95 % interval."""

    says: str
    value: float
    half: float
    unit: str


class Nameless(Effect):
    """A law that is never named: of one shape unless it says otherwise, and without parameters in trace.json."""

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One."""
        return ((),)

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """None: what is not named has none."""
        return ()

    def amount(self, fit: Fit) -> Amount | None:
        """Its size for people; None where no single number says it."""
        return None


class OfTheTorqueSensor(Nameless):
    """One that is in the reading of the torque sensor."""

    needs: ClassVar[frozenset[str]] = frozenset({"tau_l"})


def when(shown: bool, *shapes: Shape) -> tuple[Shape, ...]:
    """Those shapes, or the only one, where a campaign shows that something changes; none where it cannot."""
    return (shapes or ((),)) if shown else ()


def torque_of(signals: Signals) -> Array:
    """T, N·m, (n,); 0 where it is not known."""
    return np.nan_to_num(signals.torque)


def by_time(x: Array, signals: Signals) -> Array:
    """`x` (n,) times the time of the campaign over LONG and times its square, (n, 2)."""
    since = signals.t / LONG
    return np.stack([x * since, x * since**2], 1)


def largest_waves(signals: Signals, height: Array) -> Mapping[Port, Array]:
    """Cosine and sine of the LARGEST orders, `height` (n,) tall, (n, 4), and what they do to the lever."""
    values, slopes = signals.once("largest waves", lambda: _of_one(signals.theta_m))
    return {Port.KINEMATIC_ERROR: values * height[:, None], Port.LEVER: slopes * height[:, None]}


def _of_one(angle: Array) -> tuple[Array, Array]:
    """Those waves of height 1, and their slopes along the angle."""
    pairs = [(k, wave(k * angle)) for k in LARGEST]
    return np.hstack([x for _, x in pairs]), np.hstack([k * np.stack([-x[:, 1], x[:, 0]], 1) for k, x in pairs])


def sum_of(fit: Fit, says: str, scale: float, unit: str) -> Amount:
    """Of all its coefficients, times `scale`."""
    all_of_it = np.full(fit.covariance.shape[0], scale)
    all_of_it[fit.coefficients.size :] = 0.0
    return Amount(says, scale * float(fit.coefficients.sum()), fit.half_width(all_of_it), unit)


def wave_of(fit: Fit, says: str, scale: float, unit: str, first: int = 0) -> Amount:
    """Amplitude of a cosine, the `first` of its coefficients, and of the sine behind it, times `scale`."""
    amplitude, _ = harmonic(fit, "", unit, first, scale)
    return Amount(says, amplitude.value, (amplitude.ci95[1] - amplitude.ci95[0]) / 2, unit)
