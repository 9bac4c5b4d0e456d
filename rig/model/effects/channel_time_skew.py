"""One channel is read later than the others."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter

LOAD, MOTOR, TORQUE = 0.0, 1.0, 2.0  # of the first shape parameter: which reading is late
READING = {LOAD: "theta_l", MOTOR: "theta_m", TORQUE: "tau_l"}
STEADY, ON_AND_ON, EACH_RUN, ALONG_RUN = 0.0, 1.0, 2.0, 3.0  # of the third: whether it grows, and since when
AVERAGED = 4.0  # of the third: late as what is the mean of a while
WIDE = 1.5  # fastest over slowest
SOON = 1e-4  # s: a shift by less is its rate
FILTERED: Final = 3e-4  # s, how late a torque sensor's own low-pass may make it: 530 Hz, first order
KNOTS = np.linspace(0.0, 1.0, 13)  # of the curve along a run, shares of it


class ChannelTimeSkew(Effect):
    """An angle read at t belongs to t − δ: it reads θ(t − δ) − θ(t) too much.

    From the reading θ: −[θ(t + δ) − θ(t)], of the load the way that its speed makes in δ, of the motor −δ·(ω + δ·α/2).
    In A a late motor angle is an early load angle; what tells them apart is which inertia's torque comes late. Where
    two clocks run apart, δ grows along the campaign, δ + δ'·t, or, where they are set anew for every run, along each
    run; and a buffer that fills and is emptied makes any curve of the run's share that has gone by.

    An amplifier that gives the mean of the last w seconds, or a low-pass of one time constant, is late and blunt: its
    torque reads T(t − δ) + σ²/2·T̈ to second order, δ = w/2 and σ = w/√12 of a mean, δ = σ of a low-pass.
    """

    name: ClassVar[str] = "channel_time_skew"
    in_short: ClassVar[str] = "one channel read later than another"
    glosses: ClassVar[Mapping[str, str]] = {
        "skew_theta_l": "δ, by how much the load angle is read too late",
        "skew_theta_m": "δ, by how much the motor angle is read too late",
        "skew_tau_l": "δ, by how much the shaft torque is read too late, as by a low-pass of its own of √2/(2πδ)",
        "window_tau_l": "w, the while whose mean the shaft torque is read as; like a low-pass of time constant w/√12",
        "drift_theta_l": "δ', by how much the load angle's lateness grows per second",
        "drift_theta_m": "δ', by how much the motor angle's lateness grows per second",
        "drift_tau_l": "δ', by how much the shaft torque's lateness grows per second",
        "drift_in_run_theta_l": "δ', by how much the load angle's lateness grows per second of each run",
        "drift_in_run_theta_m": "δ', by how much the motor angle's lateness grows per second of each run",
        "drift_in_run_tau_l": "δ', by how much the shaft torque's lateness grows per second of each run",
        "scatter_theta_l": "how far the lateness of the load angle in single runs is from its mean, RMS",
        "change_in_run_theta_l": "how far apart the least and the largest lateness of the load angle in a run are",
    }
    source: ClassVar[str] = "ghorbel2001"
    needs: ClassVar[frozenset[str]] = frozenset({"t"})
    shape_names: ClassVar[tuple[str, ...]] = ("side", "about", "drifts")  # about: s, the skew the expansion is made at
    loose: ClassVar[tuple[bool, ...]] = (False, False, False)
    LONG: Final = 1e3  # s, after which δ' is told
    LARGEST: Final = 30e-3  # s; a sensor that is polled over a serial line is some ten milliseconds late
    BEYOND: Final = 0.1  # of w: what higher orders than the second add to it in waves as long as 2·w
    BLUNT: Final = 1.5  # σ² over δ²: of a low-pass it is 1, of a mean a third
    STEPS: Final = (0.0, 1e-3, -1e-3, 4e-3, -4e-3)  # s; the refit takes the coefficient as next expansion point

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Expansion points, for the sensors there are. What grows is a zero that drifts, where all runs turn one way at
        one speed."""
        sides = [side for side, reading in READING.items() if reading in reach.has]
        steady = [(side, step, STEADY) for side in sides for step in self.STEPS]
        various = reach.both_ways or reach.speeds_differ(WIDE)
        if not various:
            return tuple(steady)
        if READING[TORQUE] in reach.has:
            steady += [(TORQUE, step, AVERAGED) for step in (0.0, max(self.STEPS))]
        growing = [(side, 0.0, since) for side in sides for since in (ON_AND_ON, EACH_RUN)]
        # a curve has many numbers, and what it does to the angles is the same whichever of them is late; where the
        # wind-up was not measured it takes on whatever the weight has wrong
        measured = {"tau_l", READING[LOAD]} <= reach.has
        return (*steady, *growing, *([(LOAD, 0.0, ALONG_RUN)] if measured else []))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column, whose coefficient is δ; where it drifts a second one, for what it gains in LONG; of a curve one
        for each knot."""
        side, delta, drifts = shape
        port, late = self._late(signals, side, delta)
        if drifts == ALONG_RUN:
            return {port: -late[:, None] * along(_share(signals))}
        if drifts == AVERAGED:
            return {port: np.stack([-late, _bend(signals, delta)], 1)}
        since = _start(signals) if drifts == EACH_RUN else 0.0
        return {port: -np.stack([late, late * (signals.t - since) / self.LONG], 1) if drifts else -late[:, None]}

    def _late(self, s: Signals, side: float, delta: float) -> tuple[Port, Array]:
        """What a reading changes by in δ, over δ."""
        if side == MOTOR:
            return Port.READS_THETA_M, s.omega_m + delta / 2 * s.alpha_m
        if side == TORQUE:
            return Port.READS_TAU_L, self._rate(s, delta)
        return Port.READS_THETA_L, self._speed(s, delta)

    def _speed(self, signals: Signals, delta: float) -> Array:
        """[θ_l(t + δ) − θ_l(t)]/δ, rad/s: the mean of the smooth speed."""
        if abs(delta) < SOON:
            return signals.omega_l
        omega = np.nan_to_num(signals.omega_l)
        way = np.concatenate([[0.0], np.cumsum((omega[1:] + omega[:-1]) / 2)]) * signals.dt
        return _change(way, signals.dt, delta)

    def _rate(self, signals: Signals, delta: float) -> Array:
        """[T(t + δ) − T(t)]/δ of the smooth reading, N·m/s."""
        if abs(delta) < SOON:
            return np.nan_to_num(signals.torque_rate)
        return _change(np.nan_to_num(signals.torque), signals.dt, delta)

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """δ of the load angle, the motor angle or the shaft torque; where it drifts, δ at first and δ'; of a curve its
        mean and its range."""
        unit, name = np.eye(fit.covariance.shape[0]), READING[fit.shape[0]]
        if fit.shape[2] == ALONG_RUN:
            return self._curve(fit, name)
        skew = parameter(f"skew_{name}", fit.coefficients[0], fit.half_width(unit[0]), "s")
        if not fit.shape[2]:
            return (skew,)
        if fit.shape[2] == AVERAGED:
            window = float(np.sqrt(max(24.0 * fit.coefficients[1], 1e-18)))  # σ²/2 = w²/24
            half = fit.half_width(12.0 / window * unit[1]) + self.BEYOND * window
            return skew, parameter(f"window_{name}", window, half, "s")
        name = f"in_run_{name}" if fit.shape[2] == EACH_RUN else name
        rate = parameter(f"drift_{name}", fit.coefficients[1] / self.LONG, fit.half_width(unit[1]) / self.LONG, "s/s")
        return skew, rate

    def _curve(self, fit: Fit, name: str) -> tuple[Parameter, ...]:
        """Mean of δ over a run, and how far apart its least and its largest are."""
        unit = np.eye(fit.covariance.shape[0])
        at = fit.coefficients[: KNOTS.size]
        mean = (unit[: at.size].sum(0) - (unit[0] + unit[at.size - 1]) / 2) / (at.size - 1)  # the trapezoidal rule
        of = (("skew", mean), ("change_in_run", unit[int(np.argmax(at))] - unit[int(np.argmin(at))]))
        return tuple(parameter(f"{what}_{name}", float(x[: at.size] @ at), fit.half_width(x), "s") for what, x in of)

    def plausible(self, fit: Fit) -> bool:
        """What is the mean of a while is late by about as much as it is blunt. A torque that is late by no more than
        gauges' own low-pass makes it is in the baseline, and lacks nothing."""
        side, _, drifts = fit.shape
        if side == TORQUE and drifts == STEADY:
            return not 0.0 < fit.coefficients[0] < FILTERED
        if drifts != AVERAGED:
            return True
        delay, half_square = fit.coefficients
        return bool(0.0 < 2.0 * half_square < self.BLUNT * delay**2 and delay > 0.0)

    def expands(self, shape: Shape) -> bool:
        """About the skew itself."""
        return True

    def about(self, shape: Shape, coefficients: Array) -> Shape:
        """The skew as found, within a quarter of a period of what the low-pass passes; one that drifts is small."""
        about = (
            0.0 if shape[2] not in (STEADY, AVERAGED) else float(np.clip(coefficients[0], -self.LARGEST, self.LARGEST))
        )
        return (shape[0], about, shape[2])


def _bend(signals: Signals, delta: float) -> Array:
    """T̈(t + δ) of the smooth reading, N·m/s²."""
    bend = np.gradient(np.nan_to_num(signals.torque_rate), signals.dt)
    at = signals.dt * np.arange(bend.size)
    return np.asarray(np.interp(at + delta, at, bend))


def along(share: Array) -> Array:
    """Columns (n, k) whose coefficients are a curve's values at KNOTS, straight lines between them, of a run of which
    that `share` (n,) has gone by."""
    return np.stack([np.interp(share, KNOTS, unit) for unit in np.eye(KNOTS.size)], 1)


def _change(x: Array, dt: float, delta: float) -> Array:
    """[x(t + δ) − x(t)]/δ of rows `dt` apart; beyond either end x goes on as it did."""
    at = dt * np.arange(x.size)
    there, slopes = at + delta, (x[1] - x[0], x[-1] - x[-2])
    beyond = np.minimum(there, 0.0) * slopes[0] + np.maximum(there - at[-1], 0.0) * slopes[1]
    return np.asarray((np.interp(there, at, x) + beyond / dt - x) / delta)


def _start(signals: Signals) -> float:
    """When the run began, s."""
    return float(_whole(signals)[0])


def _share(signals: Signals) -> Array:
    """Of the run that has gone by, (n,)."""
    whole = _whole(signals)
    return np.asarray((signals.t - whole[0]) / max(whole[-1] - whole[0], signals.dt))


def _whole(signals: Signals) -> Array:
    """Times of the run that this is a part of, s."""
    return np.asarray((signals if signals.cut is None else signals.cut.whole).t)
