"""How far repeats of one run lie apart, and how much more than that a change has to be.

Repeats are runs of the same gear, procedure and operating point in one assembly. Their scatter is taken from the
differences of successive ones, so that a drift or a single jump among them counts little      [vonneumann1941]:

    s² = Σ (x_{i+1} − x_i)² / 2m,   m differences in all,   ν = (Σ m_k)² / Σ m_k²/ν_k,   ν_k = 2m_k² / (3m_k − 1)

A change between the means of n_a and n_b runs is larger than that scatter when it exceeds t·s·√(1/n_a + 1/n_b), with
Student's t for ν degrees of freedom at 99 %: of a hundred figures that did not change one is marked.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

SHARE = 0.99  # of unchanged figures that are not marked; 95 % would mark one in every comparison of twenty


@dataclass(frozen=True)
class Scatter:
    """Standard deviation of a single run among its repeats."""

    sd: float  # NaN when there are no repeats
    dof: float
    repeats: int  # runs it was found from
    sets: int  # assemblies they lie in

    @property
    def known(self) -> bool:
        """Whether there were repeats at all."""
        return self.dof > 0

    def limit(self, n_a: int = 1, n_b: int = 1) -> float:
        """What the difference of two means of unchanged runs stays below, 99 times of 100; NaN when not known."""
        return _t(self.dof) * self.sd * math.sqrt(1 / n_a + 1 / n_b) if self.known else math.nan

    def words(self, unit: str) -> str:
        """How large it is, and how it was estimated."""
        if not self.known:
            return "reproducibility not known: no repeats of the same gear, procedure, conditions and assembly"
        said = f"{self.sd:.3g}" if unit == "1" else f"{self.sd:.3g} {unit}"
        dof = f"{self.dof:.1f}".removesuffix(".0")
        freedom = f"{dof} degree of freedom" if dof == "1" else f"{dof} degrees of freedom"
        where = "one assembly" if self.sets == 1 else f"{self.sets} assemblies"
        return (
            f"scatter of a single run {said} (standard deviation, {freedom}), from "
            f"successive differences among {self.repeats} repeats of the same gear, procedure and conditions in {where}"
        )


def scatter(sets: Iterable[Sequence[float]]) -> Scatter:
    """From the values of repeats, each set in order of time; numbers that are not finite are left out."""
    squares, count, spread, repeats, used = 0.0, 0, 0.0, 0, 0
    for values in sets:
        finite = [v for v in values if math.isfinite(v)]
        m = len(finite) - 1
        if m < 1:
            continue
        squares += sum((b - a) ** 2 for a, b in pairwise(finite))
        count, spread, repeats, used = count + m, spread + (3 * m - 1) / 2, repeats + m + 1, used + 1
    if not count:
        return Scatter(math.nan, 0.0, 0, 0)
    return Scatter(math.sqrt(squares / (2 * count)), count**2 / spread, repeats, used)


def between(a: Scatter, b: Scatter) -> float:
    """The limit for the difference of two single runs of different kinds, by Welch's rule; NaN if unknown."""
    if not (a.known and b.known):
        return math.nan
    var_a, var_b = a.sd**2, b.sd**2
    if var_a + var_b == 0.0:
        return 0.0
    dof = (var_a + var_b) ** 2 / (var_a**2 / a.dof + var_b**2 / b.dof)
    return _t(dof) * math.sqrt(var_a + var_b)


@lru_cache(maxsize=1024)
def _t(dof: float) -> float:
    """Student's t, two-sided. scipy only when there is something to judge: listing must not wait for it."""
    from scipy.special import stdtrit

    return float(stdtrit(dof, (1 + SHARE) / 2))
