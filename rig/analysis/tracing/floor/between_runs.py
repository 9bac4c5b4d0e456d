"""Counts that were lost between two runs, while nobody recorded: every run from then on reads off by the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.offsets import of_the_torque_sensor, offset
from rig.analysis.tracing.runs.alike import alike
from rig.core.quantiles import Z95
from rig.model.effect import Array, Parameter, parameter

FEWEST: Final = 3  # runs on either side
CLEAR: Final = 7.0  # times the scatter of the zeros about the two levels: of 18 that walk one set in 3000 has so much
PLAINER: Final = 0.5  # of what a drift with any time constant leaves of them
CONSTANTS: Final = np.geomspace(0.03, 3.0, 20)  # of the whole time: with a longer one a drift is a straight line
AS_EVER: Final = 3.0  # usual gaps between runs: in a longer one somebody may have homed the encoders anew


@dataclass(frozen=True)
class Between:
    """The last run before the step, those from it on, by how much their zero differs [rad], and the 95 % half width of
    that."""

    last: int
    runs: tuple[int, ...]
    size: float
    half_width: float

    def columns(self, eq: Equations) -> dict[Key, Array]:
        """Of each of those runs, a zero of its own in A, (n, 1)."""
        return {(i, "A"): np.ones((eq.rows[i, "A"].y.size, 1)) for i in self.runs}

    def parameters(self) -> tuple[Parameter, ...]:
        """One step, of the load encoder: which of the two it was the zero does not tell."""
        return parameter("steps", 1.0, 0.0, "1"), parameter("step_theta_l", abs(self.size), self.half_width, "rad")

    def sentence(self, eq: Equations) -> str:
        """Where it lies."""
        return (
            f"The zeros of the encoders step once, between the runs {eq.runs[self.last].name} and "
            f"{eq.runs[self.runs[0]].name}, while nobody recorded: counts were lost, or an encoder was homed anew. "
            "Which of the two encoders it was they do not tell."
        )


def find_between(s: Solution, whole: Sequence[int]) -> Between | None:
    """Of the runs `whole`, none of them a part of one; None unless two repeats lie on either side of one step that
    explains all their zeros."""
    eq = s.design.eq
    runs = sorted((i for i in whole if (i, "A") in eq.rows and not eq.runs[i].locked), key=lambda i: eq.runs[i].start)
    if len(runs) < 2 * FEWEST:
        return None
    zeros = np.array([offset(s, i, "A") for i in runs])
    at = min(range(FEWEST, len(runs) - FEWEST + 1), key=lambda k: _scatter(zeros, k))
    size, scatter = float(zeros[at:].mean() - zeros[:at].mean()), _scatter(zeros, at)
    if scatter > PLAINER * _beside_a_drift(np.array([eq.runs[i].start for i in runs]), zeros):
        return None
    if of_the_torque_sensor(s, runs):  # which was tared anew
        return None
    if abs(size) < CLEAR * scatter or not _gap_as_ever(eq, runs, at) or not _repeated(eq, runs, at):
        return None
    return Between(runs[at - 1], tuple(runs[at:]), size, Z95 * scatter * float(np.sqrt(1 / at + 1 / (len(runs) - at))))


def _scatter(zeros: Array, at: int) -> float:
    """Of zeros (n,) about their means before and from `at` on."""
    left = np.concatenate([zeros[:at] - zeros[:at].mean(), zeros[at:] - zeros[at:].mean()])
    return float(np.sqrt(left @ left / (zeros.size - 2)))


def _beside_a_drift(times: Array, zeros: Array) -> float:
    """RMS of what the best drift leaves of zeros (n,) at those times (n,) [s]."""
    share = (times - times[0]) / max(float(np.ptp(times)), 1e-9)
    left = []
    for constant in CONSTANTS:
        z = np.stack([np.ones(share.size), np.exp(-share / constant)], 1)
        e = zeros - z @ np.linalg.lstsq(z, zeros, rcond=None)[0]
        left.append(float(np.sqrt(e @ e / (zeros.size - 2))))
    return min(left)


def _gap_as_ever(eq: Equations, runs: Sequence[int], at: int) -> bool:
    """Whether there was no longer break before the run `at` than between others."""
    begun = np.array([eq.runs[i].start for i in runs])
    ended = np.array([eq.runs[i].pieces[-1].t[-1] for i in runs])
    gaps = begun[1:] - ended[:-1]
    return bool(gaps[at - 1] <= AS_EVER * max(float(np.median(gaps)), 1.0))


def _repeated(eq: Equations, runs: Sequence[int], at: int) -> bool:
    """Whether a condition was taken on both sides: else it may be the condition that shifts the zero."""
    return any(alike(eq.runs[i], eq.runs[j]) for i in runs[:at] for j in runs[at:])
