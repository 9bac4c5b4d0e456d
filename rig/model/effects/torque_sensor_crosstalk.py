"""The torque sensor feels bending: once or twice per output turn in its reading alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals
from rig.model.gloss import waved
from rig.model.output_orders import amplitudes, below_the_first_two, once_or_twice, waves


class TorqueSensorCrosstalk(Effect):
    """The shaft torque reads c·cos(k·θ_l + φ) too much, k = 1 or 2: neither the angles nor the motor know of it

    A slip ring with a bad place has the next orders as well. What bends the sensor may be the load itself, whose rope
    pulls it to one side: then it reads T·c·cos(k·θ_l + φ) too much, or as much either way, |T|·c·cos(k·θ_l + φ).
    """

    name: ClassVar[str] = "torque_sensor_crosstalk"
    in_short: ClassVar[str] = "once or twice per output turn in the torque sensor alone"
    glosses: ClassVar[Mapping[str, str]] = waved(
        "order_{n}", "what the torque sensor reads too much, {n} times an output turn", "{n}·θ_l"
    ) | waved(
        "order_{n}_of_the_torque",
        "what the torque sensor reads too much over what it carries, {n} times an output turn",
        "{n}·θ_l",
    )
    source: ClassVar[str] = "taghirad1999"
    PLAIN, LOADED, EITHER_WAY = 0.0, 1.0, 2.0  # third shape parameter
    MOST: Final = 0.1  # of the torque: a sensor whose gain changes by more is broken
    LARGEST: Final = 3e-4  # rad times K: 2 N·m in the paper's gear, whose sensor reaches some 100 N·m
    needs: ClassVar[frozenset[str]] = frozenset({"tau_l"})
    shape_names: ClassVar[tuple[str, ...]] = ("first", "last", "by_load")
    loose: ClassVar[tuple[bool, ...]] = (False, False, False)

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Less than a sixth of an output turn looks like a trend, less than a half has no overtones. In proportion to
        the torque where weights differ: what one weight does is no proportion."""
        plain = once_or_twice(reach)
        loaded = [shape for shape in plain if shape[1] <= 2.0 and reach.weights > 1]
        both = [(1.0, 2.0)] if len(loaded) > 1 else []
        kinds = (self.LOADED, self.EITHER_WAY)
        return (*((*s, self.PLAIN) for s in plain), *((*s, kind) for kind in kinds for s in (*loaded, *both)))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of every k·θ_l, times the torque where they go with it."""
        made = waves(signals.theta_l, shape)
        if not _is_loaded(shape):
            return {Port.READS_TAU_L: made}
        torque = np.nan_to_num(signals.torque)
        return {Port.READS_TAU_L: made * (np.abs(torque) if shape[2] == self.EITHER_WAY else torque)[:, None]}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Amplitude and phase of every order."""
        return amplitudes(fit, "1", "_of_the_torque") if _is_loaded(fit.shape) else amplitudes(fit, "N·m")

    def sizes(self, parameters: Sequence[Parameter]) -> Sequence[Parameter]:
        """Once or twice a turn: a sensor that feels bending either way has no wave once a turn."""
        return parameters[0:3:2]

    def plausible(self, fit: Fit) -> bool:
        """No larger than what winds the gear up by LARGEST: sensors have tenths of a per cent of crosstalk, and what
        is much larger and turns with the output is its weight. Overtones from the third on are smaller."""
        sizes = np.hypot(fit.coefficients[::2], fit.coefficients[1::2])
        if _is_loaded(fit.shape):
            return bool(sizes.max() < self.MOST)
        return bool(sizes[:2].max() < self.LARGEST * fit.known.K) and below_the_first_two(fit)


def _is_loaded(shape: Shape) -> bool:
    return len(shape) > 2 and shape[2] != TorqueSensorCrosstalk.PLAIN
