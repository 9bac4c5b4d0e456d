"""Friction that falls as the drive warms."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter

# of the law: by the time of day, by heat of its own, by heat that soaks in, by a temperature that was logged
CLOCK, HEAT, SOAK, LOGGED = 0.0, 1.0, 2.0, 3.0


class ThermalFrictionDrift(Effect):
    """τ_f gains (τ_1·sgn ω_m + B_1·ω_m)·(c(t) − 1), c being how cold the drive still is, in one of four laws:

    0: c = exp(−t/t_w), t since the campaign began, or since it went on after a night      [wolf2018]
    1: c = exp(−β·H(t)), H the heat of its own friction, which leaks with t_w: fast runs warm it, pauses cool it
    2: c = exp(−√(t/t_w)), heat that soaks into a thick body: fast at first, for long after
    3: c − 1 = −s·(1 − exp(−(Θ − 20 °C)/s)), Θ a logged temperature: what the friction loses per kelvin at 20 °C, less
       and less as it gets warm, by e over s; s takes the place of t_w

    The baseline's τ_c and B_m are those of the cold drive, what warming takes away is here: the friction a campaign
    began with was measured, that at the end of a long warm-up may be an extrapolation. Between runs the clock goes
    on; after a rest of hours the drive is cold.

    An oil whose viscosity falls by e over some kelvins has friction F·exp(−a·(1 − exp(−t/t_w))), a = −ln(1 − τ_1/τ_c)
    where all of it falls alike. No run of a campaign tells that from law 0 with a t_w that is shorter, by up to a/2
    of itself (in two blind campaigns by a few nats of 60 000, in one of them the wrong way round): the interval of
    t_w reaches that far up.
    """

    name: ClassVar[str] = "thermal_friction_drift"
    in_short: ClassVar[str] = "friction falls as the drive warms"
    glosses: ClassVar[Mapping[str, str]] = {
        "tau_cold": "τ_1, constant friction of the cold drive that warming takes away",
        "B_cold": "B_1, viscous friction of the cold drive that warming takes away",
        "t_w": "time constant of the warm-up, longer where an oil thins exponentially, or of the heat that leaks",
        "beta": "β, by how much a joule of frictional heat takes it away",
        "gone_in_10_min": "friction at 10 rad/s that the first ten minutes take away",
        "gone_with_1_kJ": "friction at 10 rad/s that the first kilojoule of frictional heat takes away",
        "tau_per_K": "constant friction that a kelvin takes away, at 20 °C",
        "B_per_K": "viscous friction that a kelvin takes away, at 20 °C",
    }
    source: ClassVar[str] = "wolf2018"
    needs: ClassVar[frozenset[str]] = frozenset({"t"})
    shape_names: ClassVar[tuple[str, ...]] = ("t_w", "law", "beta")
    loose: ClassVar[tuple[bool, ...]] = (True, False, True)
    TIMES: Final = (120.0, 300.0, 700.0, 1600.0, 4000.0)  # s; a gear box of this size warms in 5 to 40 min
    FASTEST: Final = 30.0  # s, by which the body that friction itself heats, an oil film and its race, may warm
    LEAKS: Final = (300.0, 1200.0, 4000.0)  # s
    TWICE: Final = 2.0  # times a time constant: one that is known worse may be any
    AT: Final = 10.0  # rad/s
    WITHIN: Final = 600.0  # s
    HEATED: Final = 1000.0  # J
    SCALE: Final = 40.0  # K over which an oil's viscosity falls by e at room temperature
    SCALES: Final = (12.0, 400.0)  # K
    REFERENCE: Final = 20.0  # °C
    MOST: Final = 0.8  # of its friction that a drive may lose: no oil leaves less
    BETA: Final = 1e-3  # 1/J: 0.03/K of a lubricant in a gear box of 30 J/K

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Time constants the campaign is long enough for."""
        clocks = [(t, CLOCK, self.BETA) for t in self.TIMES if t < 2 * reach.duration]
        soaks = [(t, SOAK, self.BETA) for t in self.LEAKS if t < 2 * reach.duration]
        heats = [(t, HEAT, self.BETA) for t in self.LEAKS if t < 2 * reach.duration]
        logged = [(self.SCALE, LOGGED, self.BETA)] if "temperature" in reach.has else []
        return (*clocks, *soaks, *heats, *logged)

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """The law is chosen; β from a big cold gear box to a small one that gets hot."""
        times = (self.TIMES[0] / 3, self.TIMES[-1] * 3)
        return (min(*self.SCALES, *times), max(times)), (CLOCK, LOGGED), (self.BETA / 50, self.BETA * 20)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Constant and viscous part."""
        t_w, law, beta = shape
        if law == HEAT:
            warmed = np.expm1(-beta * signals.heat(t_w))
        elif law == LOGGED:
            scale = float(np.clip(t_w, *self.SCALES))
            above = np.nan_to_num(signals.temperature, nan=self.REFERENCE) - self.REFERENCE
            warmed = scale * np.expm1(-above / scale)
        else:
            warmed = np.expm1(-((signals.in_use / t_w) ** (0.5 if law == SOAK else 1.0)))
        return {Port.MOTOR_TORQUE: np.stack([signals.way * warmed, signals.omega_m * warmed], 1)}

    def plausible(self, fit: Fit) -> bool:
        """A cold drive has more friction, at an ordinary speed at least, and no drive warms or cools within seconds:
        what begins anew in every run is no warmth."""
        t_w, law, _ = fit.shape
        slow = law == LOGGED or t_w > self.FASTEST
        return bool(slow and fit.coefficients[0] + self.AT * fit.coefficients[1] > 0)

    def is_scaled(self, scale: Parameter, reach: Reach) -> bool:
        """Also where it may go on for most of what was measured, or longer: then it is nearly a straight line, or a
        root, of the time, and how long it would have gone on nobody can say. An interval that reaches up to there is as
        wide downward, where it is known better."""
        half = (scale.ci95[1] - scale.ci95[0]) / 2
        reaches = half < self.TWICE * scale.value and scale.ci95[1] > reach.duration / 2
        return super().is_scaled(scale, reach) or reaches or scale.value > reach.duration / 2

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """What the warm-up takes away, its time constant, and what is gone after a while of it."""
        constant, viscous, time, _, per_joule = np.eye(5)
        if fit.shape[1] == LOGGED:
            return (
                parameter("tau_per_K", fit.coefficients[0], fit.half_width(constant), "N·m/K"),
                parameter("B_per_K", fit.coefficients[1], fit.half_width(viscous), "N·m·s/(rad·K)"),
            )
        cold = (
            parameter("tau_cold", fit.coefficients[0], fit.half_width(constant), "N·m"),
            parameter("B_cold", fit.coefficients[1], fit.half_width(viscous), "N·m·s/rad"),
            self._time(fit, fit.half_width(time)),
        )
        if fit.shape[1] != HEAT:
            return (*cold, self._gone(fit))
        return (*cold, parameter("beta", fit.shape[2], fit.half_width(per_joule), "1/J"), self._gone(fit))

    def _time(self, fit: Fit, half: float) -> Parameter:
        """The time constant, which is longer where friction falls exponentially with the temperature."""
        t_w, law, _ = fit.shape
        falls = fit.coefficients[0] / fit.tau_c if law == CLOCK and fit.tau_c and fit.tau_c > 0 else 0.0
        longer = 1.0 - float(np.log1p(-min(max(0.0, falls), self.MOST))) / 2
        return Parameter("t_w", float(t_w), (float(t_w - half), float(t_w * longer + half)), "s")

    def _gone(self, fit: Fit) -> Parameter:
        """Of a warm-up that is nowhere near its end nobody can say how much it will take away in all; what it took away
        at first is known as well as ever."""
        t_w, law, beta = fit.shape
        of, by, name = (
            (beta * self.HEATED, 4, "gone_with_1_kJ") if law == HEAT else (self.WITHIN / t_w, 2, "gone_in_10_min")
        )
        root = 0.5 if law == SOAK else 1.0
        cold, left = fit.coefficients[0] + self.AT * fit.coefficients[1], np.exp(-(of**root))
        gradient = np.zeros(5)
        gradient[:2] = (1.0 - left) * np.array([1.0, self.AT])
        gradient[by] = cold * left * root * of**root * (1 / beta if law == HEAT else -1 / t_w)
        return parameter(name, cold * (1.0 - left), fit.half_width(gradient), "N·m")

    def sizes(self, parameters: Sequence[Parameter]) -> Sequence[Parameter]:
        """Constant or viscous, in all or at first."""
        return [p for p in parameters if p.name.rstrip("_0123456789") not in ("t_w", "beta")]
