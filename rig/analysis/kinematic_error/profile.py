"""Revolutions of both directions to one kinematic-error profile: coefficients with their scatter, even and odd part."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.intervals import inflation, neighbour_correlation, rms_of_pieces, t95
from rig.analysis.findings.result import Array
from rig.analysis.findings.unbiased import unbiased
from rig.analysis.orders.align import Complex
from rig.analysis.orders.revolutions import GRID, StrokeResult, filled
from rig.core.quantiles import Z95

SMALL = 0.1  # share of an amplitude up to which what inertia adds is corrected for
FEW = 8  # degrees of freedom below which the scatter of a_n and b_n is pooled
DRAWS = 400  # Monte Carlo draws of the profile; the 95 % limits of its peak to peak then repeat to a few per cent


@dataclass(frozen=True)
class Profile:
    """θ̃ over one motor turn, less its mean and its slow trend; arcsec at the output; k orders.

    With both directions `cosine`, `sine` are the even part E = (forward + reverse)/2, and `odd_cosine` is of the odd
    part O = (forward − reverse)/2; with one direction E is that direction and there is no O.
    """

    cosine: Array  # (k,) a_n
    sine: Array  # (k,) b_n
    u_cosine: Array  # (k,) 1 σ, from the scatter of the revolutions
    u_sine: Array
    u_system: Array  # (k,) 1 σ of what does not scatter (inertia's share), of the amplitude
    odd_cosine: Array | None
    dof: float  # degrees of freedom behind the scatter
    rho: float  # correlation of neighbouring revolutions
    forward: int  # revolutions
    reverse: int
    curve_forward: Array | None  # (G,)
    curve_reverse: Array | None
    floor: float  # arcsec², variance of the averaged curve that comes from the scatter of the revolutions
    residual_rms: tuple[float, float]  # arcsec, of single rows, and half of its 95 % interval

    @property
    def terms(self) -> int:
        return self.cosine.size

    @property
    def factor(self) -> float:
        """What one σ is multiplied by for 95 %."""
        return t95(self.dof)

    @property
    def amplitude(self) -> Array:
        return np.hypot(self.cosine, self.sine)

    @property
    def u_amplitude(self) -> Array:
        """1 σ of each amplitude: random part along the direction of (a, b), and the systematic part."""
        size = np.maximum(self.amplitude, 1e-300)
        random = ((self.cosine * self.u_cosine) ** 2 + (self.sine * self.u_sine) ** 2) / size**2
        return np.asarray(np.sqrt(random + self.u_system**2))

    def pure(self) -> Array:
        """The averaged curve itself: E where both directions were run, else the one there is, shape (G,)."""
        curves = [c for c in (self.curve_forward, self.curve_reverse) if c is not None]
        mean = np.mean(curves, axis=0)
        return np.asarray(mean - mean.mean())

    def direction(self) -> Array | None:
        """O without its mean, shape (G,)."""
        if self.curve_forward is None or self.curve_reverse is None:
            return None
        half = 0.5 * (self.curve_forward - self.curve_reverse)
        return np.asarray(half - half.mean())

    def fit(self) -> Array:
        """Σ a_n cos nθ + b_n sin nθ on the grid, shape (G,)      [ghorbel2001, Eq. 8]"""
        return np.asarray(_basis(self.terms) @ np.concatenate((self.cosine, self.sine)))

    @property
    def system_half(self) -> float:
        """Half width (95 %) that the systematic parts leave on a peak to peak, as if all their peaks met, arcsec."""
        return float(2.0 * Z95 * np.sqrt(np.sum(self.u_system**2)))

    def peak_to_peak(self) -> tuple[float, tuple[float, float]]:
        """Peak to peak of the fitted series with its 95 % interval, arcsec.

        Noise makes a peak to peak larger. Monte Carlo from the coefficients' uncertainties finds by how much (that is
        taken off) and how far the value scatters; the systematic parts are added as if all their peaks met.
        """
        basis = _basis(self.terms)
        best = np.concatenate((self.cosine, self.sine))
        spread = np.concatenate((self.u_cosine, self.u_sine))
        if not np.all(np.isfinite(spread)):
            return float(np.ptp(basis @ best)), (float("nan"), float("nan"))
        draws = best + np.random.default_rng(0).standard_normal((DRAWS, best.size)) * spread  # same file, same interval
        sizes = np.ptp(draws @ basis.T, axis=1)
        plain = float(np.ptp(basis @ best))
        value, scatter = unbiased(plain, sizes)
        half = float(np.hypot(self.factor * scatter, self.system_half))
        return value, (max(value - half, 0.0), value + half)


def phasors(p: Profile, k: int) -> Complex:
    """a_n − j·b_n of orders 1..k, arcsec."""
    return np.asarray(p.cosine[:k] - 1j * p.sine[:k])


def u_phasors(p: Profile, k: int) -> Array:
    """1 σ of one part of each phasor, what does not scatter included, (k,)."""
    random = 0.5 * (p.u_cosine[:k] ** 2 + p.u_sine[:k] ** 2)
    return np.asarray(np.sqrt(random + p.u_system[:k] ** 2))


def _basis(terms: int) -> Array:
    """(G, 2·terms): cos nθ, then sin nθ, in the middle of each bin."""
    angle = np.multiply.outer((np.arange(GRID) + 0.5) * (2 * np.pi / GRID), np.arange(1, terms + 1))
    return np.concatenate((np.cos(angle), np.sin(angle)), axis=1)


def _mean_curve(strokes: list[StrokeResult]) -> Array | None:
    if not strokes:
        return None
    curve = filled(sum(s.total for s in strokes), sum(s.position for s in strokes), sum(s.rows for s in strokes))  # type: ignore[arg-type]
    return np.asarray(curve - curve.mean())


def _scatter(side: list[StrokeResult]) -> float:
    """Σ over the revolutions of one direction of (curve − mean curve)², mean over the grid; stroke by stroke."""
    flat = [s.curves.mean(axis=1, keepdims=True) for s in side]
    sums = [np.sum(s.curves - level, axis=0) for s, level in zip(side, flat, strict=True)]
    mean = np.sum(sums, axis=0) / sum(s.curves.shape[0] for s in side)
    return sum(float(np.mean(np.sum((s.curves - f - mean) ** 2, axis=0))) for s, f in zip(side, flat, strict=True))


def _pooled(deviations: Array, dof: int, rho: float) -> tuple[Array, int]:
    """Variance (2k,) of the coefficients of one revolution by `deviations` (revolutions, 2k), and with how many degrees
    of freedom it is known; NaN where there are none.
    """
    if dof <= 0:
        return np.full(deviations.shape[1], np.nan), dof
    variance = np.sum(deviations**2, axis=0) / dof * inflation(rho)
    if dof >= FEW:
        return variance, dof
    # noise has no favourite angle: a_n and b_n scatter alike, and two together are known better
    return np.tile(variance.reshape(2, -1).mean(axis=0), 2), 2 * dof


def combine(strokes: list[StrokeResult], added: Array) -> Profile:
    """Average the revolutions of all `strokes`, each direction by itself, then both with equal weight.

    The variance of a mean comes from the scatter of the revolutions about the mean of their direction, pooled over
    both directions (friction wander and quantisation do not know the direction), widened when neighbours correlate.
    `added` (k,): share of each amplitude that inertia adds at this speed. Where it is small it is taken off and half
    of it kept as 1 σ, for what is declared is not known exactly; where it is not, all of it is 1 σ      [gum, 4.3]
    """
    sides = [[s for s in strokes if s.direction == d] for d in (1, -1)]
    used = [side for side in sides if side]
    means, deviations, scatter = [], [], 0.0
    for side in used:
        joined = np.concatenate([np.hstack((s.cosine, s.sine)) for s in side])
        means.append(joined.mean(axis=0))
        deviations += [np.hstack((s.cosine, s.sine)) - means[-1] for s in side]
        scatter += _scatter(side)
    counts = [sum(s.cosine.shape[0] for s in side) for side in used]
    share = sum(1.0 / n for n in counts) / len(used) ** 2  # variance of the even part in units of one revolution's
    dof = sum(counts) - len(used)
    rho = neighbour_correlation(deviations)
    floor = scatter / dof * share if dof > 0 else float("nan")
    variance, dof = _pooled(np.concatenate(deviations), dof, rho)
    small = added <= SMALL
    even = np.mean(means, axis=0) * np.tile(np.where(small, 1.0 - added, 1.0), 2)
    odd = 0.5 * (means[0] - means[1]) if len(used) == 2 else None
    u = np.sqrt(variance * share)
    k = even.size // 2
    return Profile(
        cosine=even[:k],
        sine=even[k:],
        u_cosine=u[:k],
        u_sine=u[k:],
        u_system=np.where(small, 0.5, 1.0) * added * np.hypot(even[:k], even[k:]),
        odd_cosine=None if odd is None else odd[:k],
        dof=dof / inflation(rho),
        rho=rho,
        forward=sum(s.cosine.shape[0] for s in sides[0]),
        reverse=sum(s.cosine.shape[0] for s in sides[1]),
        curve_forward=_mean_curve(sides[0]),
        curve_reverse=_mean_curve(sides[1]),
        floor=floor,
        residual_rms=rms_of_pieces(
            np.concatenate([s.residual_square for s in strokes]), np.concatenate([s.residual_rows for s in strokes])
        ),
    )


def truncation(curve: Array, terms: int) -> Array:
    """MSE(k) = ⟨θ̃_p²⟩ − ½ Σ_{n≤k} (a_n² + b_n²) for k = 0..terms, arcsec²      [ghorbel2001, Fig. 6]

    `curve` (G,) arcsec with zero mean. By Parseval: what the series still lacks after k terms.
    """
    spectrum = np.fft.rfft(curve) / curve.size
    power = 2.0 * np.abs(spectrum[1:]) ** 2
    return np.asarray(np.concatenate((np.cumsum(power[::-1])[::-1], [0.0]))[: terms + 1])


def chosen_terms(mse: Array, floor: float) -> int:
    """The smallest k with MSE(k) ≤ 1.1·MSE(last), or with MSE(k) below the noise floor."""
    enough = (mse <= 1.1 * mse[-1]) | (mse <= (floor if np.isfinite(floor) else 0.0))
    return int(np.argmax(enough))
