"""Sub-divisional error: each line of an encoder is divided unevenly."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic
from rig.model.gloss import waved
from rig.model.waves import wave

MOTOR, LOAD = 0.0, 1.0  # of the first shape parameter
MEANT = 50  # rows, whose mean has little noise left


class EncoderInterpolationError(Effect):
    """An angle reads e·cos(L·θ + φ) too much, L its lines per turn: a divisor of its counts per turn

    Only where a line passes slower than the samples come; beyond that it aliases and cannot be told from noise.
    """

    name: ClassVar[str] = "encoder_interpolation_error"
    in_short: ClassVar[str] = "orders of the encoder's line count"
    glosses: ClassVar[Mapping[str, str]] = {
        **waved("load_{n}_lines", "the load encoder's error, once a line of {n} a turn", "{n}·θ_l"),
        **waved("motor_{n}_lines", "the motor encoder's error, once a line of {n} a turn", "{n}·θ_m"),
    }
    source: ClassVar[str] = "ghorbel2001"
    shape_names: ClassVar[tuple[str, ...]] = ("side", "lines")
    loose: ClassVar[tuple[bool, ...]] = (False, False)
    LEAST: Final = (16, 900)  # lines of motor and load encoder: fewer are orders of the gear
    MULTIPLES: Final = (1, 3)  # an error that is large against a line is read through itself, and then has a third wave
    WAVES: Final = (1, 2)  # of a line that is seen, beside which stands one more or less where its size goes round once

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Divisors of the counts, and line counts that the residual shows with their neighbours (off its centre, a
        disc's error swells once a turn), which the slowest run samples at least three times a line."""
        out: list[Shape] = []
        for side, counts, seen in ((MOTOR, reach.counts_m, reach.lines_m), (LOAD, reach.counts_l, reach.lines_l)):
            highest, least = self.highest(reach, side == LOAD), self.LEAST[int(side)]
            said = {m * n for n in divisors(int(counts)) if n >= least for m in self.MULTIPLES if 4 * m * n <= counts}
            beside = {m * n + k for n in seen for m in self.WAVES for k in (-1, 1)}
            out += [(side, float(n)) for n in sorted({*said, *seen, *beside}) if n <= highest]
        return tuple(out)

    @staticmethod
    def highest(reach: Reach, of_load: bool) -> float:
        """Most lines per turn of an encoder that the slowest run samples three times each. A load that is locked passes
        no line: there a wave of its angle is a straight line through the noise of that reading, and takes it away."""
        speed = reach.slowest_free / reach.ratio if of_load else reach.slowest
        return reach.rate / 3.0 / (speed / (2.0 * np.pi)) if speed > 0 else 0.0

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of the line angle."""
        side, lines = shape
        if side == LOAD:
            theta_l = at_rest(signals.theta_l, 2.0 * np.pi / lines)
            x, kept, port = lines * theta_l, signals.kept(lines, signals.omega_l), Port.READS_THETA_L
        else:
            x, kept, port = lines * signals.theta_m, signals.kept(lines, signals.omega_m), Port.READS_THETA_M
        return {port: wave(x, kept)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Amplitude and phase, named by side and line count."""
        side = "load" if fit.shape[0] == LOAD else "motor"
        return harmonic(fit, f"{side}_{fit.shape[1]:g}_lines", "rad")


def at_rest(theta: Array, line: float) -> Array:
    """`theta` rad (n,) itself, or its mean where it passes less than half a `line`: as of a load that is locked. A wave
    of that is a straight line through the noise of the reading, and would take the noise away."""
    if not theta.size:
        return theta
    means = [part.mean() for part in np.array_split(theta, max(theta.size // MEANT, 1))]
    return theta if np.ptp(means) > line / 2.0 else np.full(theta.size, theta.mean())


def divisors(number: int) -> list[int]:
    """All divisors of `number`, ascending; none of 0."""
    small = [d for d in range(1, int(number**0.5) + 1) if number % d == 0]
    return sorted({*small, *(number // d for d in small)})
