"""A torque constant that is another one in each lock test: magnets weaken as the winding warms, a sensor's gain drifts.

Every lock test has a gain of its own between the two torques, so that no error shows it. But gains are known to some
hundredths of a per cent there, and a gain that merely wanders is another one in repeats of runs under load as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.offsets import offset
from rig.analysis.tracing.runs.alike import repeats
from rig.core.quantiles import Z95

KNOWN: Final = 2e-4  # of the torque, half a 95 % interval: that of a test over 60 N·m of the motor is 1e-4
CLEAR: Final = 6.0  # times that, how far apart two are
LEAST: Final = 8e-4  # of the torque
STEADY: Final = 0.5  # of how far the gains lie apart: how far those of loaded repeats may
LOADED: Final = 0.4  # of the largest load: under less, repeats tell of friction that scatters


class Gain(NamedTuple):
    """By which share the motor's torque exceeds the sensor's in a run, and half its 95 % interval."""

    run: str
    value: float
    half: float


@dataclass(frozen=True)
class GainsOfLocks:
    """The least and the largest of all lock tests, and by how much gains of loaded repeats differ at most."""

    least: Gain
    most: Gain
    repeated: float

    def sentence(self) -> str:
        """What is said of it."""
        each = " and by ".join(
            f"{100 * gain.value:.3f} ± {100 * gain.half:.3f} % in {gain.run}" for gain in (self.least, self.most)
        )
        return (
            f"The motor's torque exceeds the shaft's by {each}, where repeats under load differ by "
            f"{100 * self.repeated:.2g} % at most: its torque constant falls as the winding warms, or the gain of the "
            "torque sensor drifts. Every lock test has a gain of its own, so that no error shows it, and no effect of "
            "the library explains it."
        )


def gains_of_locks(s: Solution, runs: Sequence[int]) -> GainsOfLocks | None:
    """None where fewer than two lock tests among `runs` tell their gain, where those agree, or where no loaded runs
    repeat theirs better."""
    found = [gain for i in runs if (gain := _gain(s, i)) is not None]
    known = sorted((gain for gain in found if gain.half < KNOWN), key=lambda gain: gain.value)
    if len(known) < 2:
        return None
    least, most = known[0], known[-1]
    apart = most.value - least.value
    if apart < max(LEAST, CLEAR * max(least.half, most.half)):
        return None
    repeated = max(_of_loaded_repeats(s, runs), default=np.inf)
    return GainsOfLocks(least, most, repeated) if repeated < STEADY * apart else None


def _gain(s: Solution, run: int) -> Gain | None:
    """Of a lock test whose shaft torque was read."""
    eq, key = s.design.eq, (run, "M")
    test = eq.runs[run]
    if key not in eq.rows or not test.locked or test.is_wound or "tau_l" not in test.has:
        return None
    r = eq.rows[key]
    z = np.hstack([np.ones((r.y.size, 1)), r.own])
    x, _, rank, _ = np.linalg.lstsq(z, left := r.y - r.z @ s.x[list(r.at)], rcond=None)
    if rank < z.shape[1] or r.y.size <= rank:
        return None
    variance = float(np.mean((left - z @ x) ** 2)) * eq.noise.kappa["M"] * float(np.linalg.inv(z.T @ z)[1, 1])
    return Gain(test.name, test.ratio * float(x[1]), test.ratio * Z95 * float(np.sqrt(variance)))


def _of_loaded_repeats(s: Solution, runs: Sequence[int]) -> list[float]:
    """By how much the gains of two repeats under load differ, shares of the torque."""
    eq = s.design.eq
    free = [i for i in runs if (i, "M") in eq.rows and not eq.runs[i].locked and "tau_l" in eq.runs[i].has]
    most = max((abs(eq.runs[i].mean_torque) for i in free), default=0.0)
    loaded = [i for i in free if abs(eq.runs[i].mean_torque) > LOADED * most > 0.0]
    gaps = [(offset(s, a, "M") - offset(s, b, "M"), eq.runs[a]) for a, b in repeats(eq.runs, loaded)]
    return [abs(gap) * run.ratio / abs(run.mean_torque) for gap, run in gaps]
