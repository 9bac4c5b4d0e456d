"""A rate of successes with its exact 95 % interval (Clopper and Pearson 1934)."""

from __future__ import annotations

from dataclasses import dataclass

from scipy.stats import beta


@dataclass(frozen=True)
class Rate:
    """`hits` of `trials`."""

    hits: int
    trials: int

    def interval(self) -> tuple[float, float]:
        """95 % interval of the rate; (0, 1) when nothing was tried."""
        k, n = self.hits, self.trials
        low = 0.0 if k == 0 else float(beta.ppf(0.025, k, n - k + 1))
        high = 1.0 if k == n else float(beta.ppf(0.975, k + 1, n - k))
        return low, high

    def __str__(self) -> str:
        if not self.trials:
            return "none tried"
        low, high = self.interval()
        share = self.hits / self.trials
        return f"{self.hits} of {self.trials} = {share:.0%} ({low:.0%} to {high:.0%})"


def rate(flags: list[bool]) -> Rate:
    return Rate(sum(flags), len(flags))
