"""Sentinels of one campaign side by side: has the rig changed between them by more than they can tell?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from rig.analysis.findings.result import Array, Estimate
from rig.core.quantiles import Z95

WATCHED = ("mean_speed", "mean_motor_torque", "kinematic_error_peak_to_peak", "fourier_amplitude_2")
"""The figures that are compared, by their machine names."""
ONCE_IN = 20  # campaigns of an unchanged rig, at most, one is said to have changed


@dataclass(frozen=True)
class Watched:
    """One figure over the sentinels of a campaign, in their order."""

    name: str
    label: str
    unit: str
    value: Array  # (m,)
    half: Array  # (m,) half widths of the 95 % intervals
    change: float  # last less first
    change_half: float  # half width of its interval, by which it is judged: 95 % for all that is compared together
    changed: bool  # whether any two differ by more than that interval of theirs
    most: tuple[int, int]  # the two that differ most beyond theirs, in their order

    @property
    def sentence(self) -> str:
        """For the campaign's report."""
        word = "changed" if self.changed else "did not change by more than the sentinels can tell"
        said = (
            f"{self.label} {word}: {self.value[0]:.4g} {self.unit} first, {self.value[-1]:.4g} {self.unit} last, "
            f"change {self.change:+.3g} ± {self.change_half:.2g} {self.unit} over {self.value.size} sentinels"
        )
        if self.changed and abs(self.change) <= self.change_half:
            i, j = self.most
            said += f"; sentinels {i + 1} and {j + 1} differ by {self.value[j] - self.value[i]:+.3g} {self.unit}"
        return f"{said} (interval: 95 % for all that is compared together)."


def compare(sentinels: Sequence[Sequence[Estimate]]) -> tuple[Watched, ...]:
    """Each watched figure that all `sentinels` have with an interval; their estimates in the order they were run."""
    found = []
    for name in WATCHED:
        estimates = [next((e for e in one if e.name == name), None) for one in sentinels]
        known = [e for e in estimates if e is not None and np.isfinite(e.ci95).all()]
        if len(known) == len(sentinels) >= 2:
            found.append(_watched(known))
    return tuple(found)


def _watched(estimates: list[Estimate]) -> Watched:
    first = estimates[0]
    value = np.array([e.value for e in estimates])
    half = np.array([0.5 * (e.ci95[1] - e.ci95[0]) for e in estimates])
    apart = np.abs(value[:, None] - value[None, :])
    together = _widened(value.size) * np.hypot(half[:, None], half[None, :])
    i, j = np.triu_indices(value.size, 1)
    worst = int(np.argmax(apart[i, j] - together[i, j]))
    return Watched(
        first.name,
        first.label,
        first.unit,
        value,
        half,
        float(value[-1] - value[0]),
        float(together[0, -1]),
        bool((apart > together).any()),
        (int(i[worst]), int(j[worst])),
    )


def _widened(sentinels: int) -> float:
    """How many times wider than 95 % the intervals are taken: every pair of every figure is a chance to be wrong."""
    pairs = len(WATCHED) * sentinels * (sentinels - 1) / 2
    return NormalDist().inv_cdf(0.5 + 0.5 * (1.0 - 1.0 / ONCE_IN) ** (1.0 / pairs)) / Z95
