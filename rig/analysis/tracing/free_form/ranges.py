"""What fitted runs cover, cut into knots: between two of them a form is straight."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.tracing.runs.recording import Recording
from rig.model.effect import Array, Signals

APART: Final = 0.01  # of the range, the least between knots: closer ones are one speed that wavers
EVERY: Final = 7  # rows of which one is looked at: knots want no more


@dataclass(frozen=True)
class Ranges:
    """The fitted runs, whose rows are cut."""

    runs: tuple[Recording, ...]

    def even(self, of: Callable[[Signals], Array], count: int) -> Array:
        """Knots as far apart as each other, (count,); none of what nobody read."""
        x = self._values(of)
        return np.linspace(x.min(), x.max(), count) if x.size and np.ptp(x) > 0 else np.zeros(0)

    def crowded(self, of: Callable[[Signals], Array], count: int) -> Array:
        """Knots with as many rows between them, as far as rows differ: (up to count,)."""
        x = self._values(of)
        if not x.size or np.ptp(x) == 0:
            return np.zeros(0)
        kept: list[float] = []
        for knot in np.quantile(x, np.linspace(0, 1, count)).tolist():
            if not kept or knot - kept[-1] > APART * np.ptp(x):
                kept.append(knot)
        return np.array(kept)

    def _values(self, of: Callable[[Signals], Array]) -> Array:
        """Of all rows that were read, (n,)."""
        x = np.concatenate([of(piece)[::EVERY] for run in self.runs for piece in run.pieces])
        return np.asarray(x[np.isfinite(x)])
