"""The loop: wind-up gap at zero torque, energy lost per cycle, and what of its width depends on the rate."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Array
from rig.analysis.stiffness.branches import Ramp
from rig.analysis.stiffness.curve import Curve
from rig.analysis.stiffness.points import Points

NEAR = 0.2  # of the largest torque: rows nearer to zero torque say how wide the loop is there
PIECES = 8  # of a ramp near zero, in time: their scatter says how sure its mean is
LEAST = 4  # rows in each
DEAD = 0.05  # of the secant stiffness: less slope at zero is play
SAME = 0.3  # rates that differ by a smaller share are one rate
SPAN = 2.0  # factor the rates have to span for their effect to be told


@dataclass(frozen=True)
class Width:
    """Half of the loop's width at zero torque, of one ramp."""

    direction: int
    rate: float  # rad/s; NaN without time
    half: float  # N·m, positive when the torque resists the motion
    u: float  # N·m, 1 σ of it from its scatter along the ramp


@dataclass(frozen=True)
class Value:
    """A number and the half width of its 95 % interval; NaN where the run shows none."""

    value: float
    half: float

    @property
    def told(self) -> bool:
        """Whether it is told from zero."""
        return abs(self.value) > self.half


@dataclass(frozen=True)
class RateLaw:
    """Half width = hysteretic + viscous·rate."""

    hysteretic: Value  # N·m, at no rate at all
    viscous: Value  # N·m·s/rad at the output
    slowest: float  # rad/s
    fastest: float

    def words(self) -> str:
        """Which of the two it is, with the numbers."""
        at = f"{self.viscous.value * self.slowest:.3g} to {self.viscous.value * self.fastest:.3g} N·m"
        h, v = self.hysteretic, self.viscous
        lossy = h.told and h.value > 0  # a width below zero is scatter, and no hysteresis
        rates = f"over a factor of {self.fastest / self.slowest:.2g} in rate"
        fixed = f"{_beside(h)} N·m of the half width do not change {rates}"
        moving = f"what grows with the rate is {_beside(v)} N·m·s/rad ({at})"
        if lossy and v.told:
            return f"The loop is hysteretic and viscous: {fixed}; {moving}."
        if lossy:
            return f"The loop is hysteretic: {fixed}; {moving}, not told from none."
        if v.told:
            return f"The loop is viscous: {moving}; {fixed}, not told from none."
        return f"There is no loop to be told from none: {fixed}; {moving}."


def _beside(found: Value) -> str:
    """Value ± half, both to the place of the half's second digit: no "1e+02" for a person."""
    if not found.half > 0.0 or not math.isfinite(found.half):
        return f"{found.value:.3g} ± {found.half:.2g}"
    places = 1 - math.floor(math.log10(found.half))
    value, half = round(found.value, places), round(found.half, places)
    return f"{value:.{max(places, 0)}f} ± {half:.{max(places, 0)}f}"


def widths(ramps: list[Ramp], curve: Curve, windup: Array, tau: Array) -> list[Width]:
    """Of every ramp that came from a turn under load and passed near zero torque.

    Means over the rows as they are, equal in time: where the motor sticks and slips, the mean of the viscous torque is
    then that of the mean rate.
    """
    near = NEAR * float(np.max(np.abs(tau)))
    found = []
    for ramp in ramps:
        w, y = windup[ramp.lo : ramp.hi], tau[ramp.lo : ramp.hi]
        spring = curve.torque(w)
        here = np.abs(spring) <= near
        opened = curve.shape.opened(np.abs(w - ramp.begin))
        if ramp.on_loop and here.sum() >= LEAST * PIECES:
            # a loop that still opens over these rows is as wide at zero torque as it is there
            at_zero = float(curve.shape.opened(np.array([abs(curve.middle - ramp.begin)]))[0])
            wider = float(np.clip(at_zero / max(float(opened[here].mean()), 0.2), 0.8, 1.25))
            rest = ramp.direction * (y[here] - spring[here]) * wider
            pieces = [float(piece.mean()) for piece in np.array_split(rest, PIECES)]
            found.append(
                Width(ramp.direction, ramp.rate, float(rest.mean()), float(np.std(pieces, ddof=1)) / PIECES**0.5)
            )
    return found


def gap(found: list[Width], curve: Curve) -> Value | None:
    """Wind-up between falling and rising ramps at zero torque [rad]; None unless both were run."""
    up = np.array([x.half for x in found if x.direction > 0])
    down = np.array([x.half for x in found if x.direction < 0])
    if not (up.size and down.size):
        return None
    K = float(curve.tangent(np.array([curve.middle]))[0])
    if K < DEAD * curve.scale.K:  # within play there is no slope: the gap is then what the loop adds to the play
        K = curve.scale.K
    dof = up.size + down.size - 2
    # one ramp each way: what scatters along the ramps has to do
    half = t95(PIECES - 1) * float(np.sqrt(sum(x.u**2 for x in found)))
    if dof > 0:
        squares = float(np.sum((up - up.mean()) ** 2) + np.sum((down - down.mean()) ** 2))
        half = t95(dof) * float(np.sqrt(squares / dof * (1 / up.size + 1 / down.size)))
    return Value(float(up.mean() + down.mean()) / K, half / K)


def rate_law(found: list[Width], unsure: float = 0.0) -> RateLaw | None:
    """Half width against rate, both directions together; None where the rates span less than a factor of two.

    `unsure` N·m is half the 95 % interval of what scatters from rate to rate, not from ramp to ramp.
    """
    rate, half = np.array([x.rate for x in found]), np.array([x.half for x in found])
    way = np.array([float(x.direction) for x in found])
    if rate.size < 4 or not np.isfinite(rate).all() or not rate.max() > SPAN * rate.min() > 0:
        return None
    # the third column is what shifts both branches alike (zero of the sensor): it must not pass for width
    design = np.stack((np.ones(rate.size), rate / rate.max(), way), axis=1)
    if np.ptp(way) == 0:
        design = design[:, :2]
    found_x, _, rank, _ = np.linalg.lstsq(design, half, rcond=None)
    dof = half.size - design.shape[1]
    if rank < design.shape[1] or dof < 1:
        return None
    variance = float(np.sum((half - design @ found_x) ** 2)) / dof
    u = t95(dof) * np.sqrt(variance * np.diag(np.linalg.inv(design.T @ design)))
    return RateLaw(
        Value(float(found_x[0]), float(np.hypot(u[0], unsure))),
        Value(float(found_x[1] / rate.max()), float(np.hypot(u[1] / rate.max(), 2**0.5 * unsure / np.ptp(rate)))),
        float(rate.min()),
        float(rate.max()),
    )


def energy(ramps: list[Ramp], points: Points) -> list[tuple[float, float]]:
    """(rate rad/s, ∮ τ dw J) of every ramp from end to end and the one back at the same rate.

    Means over cells, not rows: where a motor at rest flickers between two counts, the area between the flicker and the
    sensor's noise would be counted too.
    """
    out = []
    for k, (a, b) in enumerate(pairwise(ramps)):
        same = not abs(a.rate / b.rate - 1.0) > SAME
        if a.whole and b.whole and a.on_loop and b.on_loop and same and a.direction != b.direction:
            up, down = (k, k + 1) if a.direction > 0 else (k + 1, k)
            out.append((a.rate, _between(points.pick(points.ramp == up), points.pick(points.ramp == down))))
    return out


def _between(up: Points, down: Points) -> float:
    """Area between two branches over the wind-up they share [J]."""
    up, down = up.pick(np.argsort(up.windup)), down.pick(np.argsort(down.windup))
    grid = np.linspace(max(up.windup[0], down.windup[0]), min(up.windup[-1], down.windup[-1]), 2000)
    apart = np.interp(grid, up.windup, up.tau) - np.interp(grid, down.windup, down.tau)
    return float(apart.mean() * (grid[-1] - grid[0]))


def energy_of(curve: Curve, rate: float) -> float:
    """∮ τ dw [J] of the fitted loop between ±reach at `rate` rad/s, for runs that close no loop of their own."""
    way = np.linspace(0.0, 2 * curve.scale.reach, 2001)
    return 2.0 * float(np.mean(curve.half_width * curve.shape.opened(way)) + curve.viscous * rate) * float(way[-1])
