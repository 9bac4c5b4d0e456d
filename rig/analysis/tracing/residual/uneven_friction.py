"""Friction that is more one way, by the same at every speed: every run has a zero of the motor's torque of its own,
which takes it on, so that no error shows it.

It is told by what the motor's torque is in the mean of both ways where nothing hangs on the output, and by a run at
standstill, which has the zero of its reading and none of the friction. Runs of one way each, at a like speed, tell
whether it is as much when the motor turns faster: friction that falls as the motor speeds up may fall from more one way
(exam 93, case 19).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.special import stdtrit

from rig.analysis.tracing.runs.alike import ONE_WAY
from rig.analysis.tracing.runs.recording import Recording, mean_speed, mean_way

RUNS: Final = 2  # that turn both ways
EACH_WAY: Final = 0.2  # of the rows, at least
STILL: Final = 0.2  # of what is seen: a zero that is as much may be all of it
CARRIED: Final = 0.5  # of what is seen, at the motor: what the load pulls one way
ALIKE: Final = 5.0  # standard errors
AS_FAST: Final = 1.1  # times: speeds forth and back that make a pair
STAYS: Final = 0.5  # of what is seen slowly: what is left of it faster, else it goes away with the speed
LARGE: Final = 1.0  # floors of the motor's torque: less matters to nobody


@dataclass(frozen=True)
class UnevenFriction:
    """By how much friction is more forward than backward, at the motor, and the 95 % half width of it [N·m]; whether
    faster runs have it too, or nobody knows."""

    size: float
    half: float
    faster: bool

    def sentence(self) -> str:
        """What is said of it."""
        way = "forward" if self.size > 0 else "backward"
        anywhere = ", whatever the speed," if self.faster else ""
        return (
            f"The motor needs {1e3 * abs(self.size):.3g} ± {1e3 * self.half:.2g} mN·m more torque {way} than the other "
            f"way{anywhere} while its torque reads zero at standstill: friction that is another one each "
            "way. Every run has a zero of its own for that torque, so that no error shows it, and no effect of the "
            "library explains it."
        )


def uneven_friction(runs: Sequence[Recording], floor: float, torque_zero: float) -> UnevenFriction | None:
    """Of the runs of a campaign, standstill among them, whose torque sensor has that zero [N·m]; None where both ways
    are alike to `floor` [N·m] or become so the faster the motor turns, the reading may have that zero, or something
    pulls one way: a weight out of balance does where the output goes a part of its turn, and the sensor's zero may hide
    it (exam 92, case 34)."""
    still = [r for r in runs if r.procedure == "standstill" and "tau_m" in r.has]
    both = [m for r in runs if (m := _mean_of_both_ways(r)) is not None]
    if not still or len(both) < RUNS:
        return None
    found = np.array([motor for motor, _ in both])
    mean, error = float(found.mean()), float(found.std(ddof=1)) / np.sqrt(found.size)
    zero = max(abs(float(np.mean(x))) if np.ptp(x := _all(r, "tau_m")) > 0 else np.inf for r in still)
    pulled = float(np.mean([load for _, load in both])) - torque_zero / still[0].ratio
    if zero > STILL * abs(mean) or not abs(pulled) <= CARRIED * abs(mean):
        return None
    faster = _of_one_way_runs(runs)
    if abs(mean) < max(LARGE * floor, ALIKE * error) or (faster is not None and faster / mean < STAYS):
        return None
    return UnevenFriction(2.0 * mean, 2.0 * float(stdtrit(found.size - 1, 0.975)) * error, faster is not None)


def _of_one_way_runs(runs: Sequence[Recording]) -> float | None:
    """Torque of the motor in the mean of both ways [N·m], of runs that turn one way each, forth and back as fast; None
    where there are no such."""
    turned = [(mean_speed(r), float(np.mean(_all(r, "tau_m")))) for r in runs if _turns_one_way(r)]
    pairs = [
        (forth + back) / 2
        for fast, forth in turned
        for slow, back in turned
        if fast > 0 > slow and 1 / AS_FAST < -fast / slow < AS_FAST
    ]
    return float(np.mean(pairs)) if pairs else None


def _turns_one_way(run: Recording) -> bool:
    return _is_free(run) and abs(mean_way(run)) > ONE_WAY


def _is_free(run: Recording) -> bool:
    """Whether it turned with nothing on it, as somebody stated, and its torques were read."""
    if run.locked or run.procedure == "standstill" or not {"tau_m", "tau_l"} <= run.has or not run.load_stated:
        return False
    return not any(np.any(piece.tau_ext) for piece in run.pieces)


def _mean_of_both_ways(run: Recording) -> tuple[float, float] | None:
    """Torque of the motor, and of the load at the motor, N·m, in the mean of both ways; None where it did not turn both
    ways with nothing on it, or one of them was not measured."""
    if not _is_free(run):
        return None
    way = _all(run, "way")
    ways = [way == side for side in (1, -1)]
    if min(float(np.mean(mine)) for mine in ways) < EACH_WAY:
        return None
    motor, load = (float(np.mean([np.mean(_all(run, name)[mine]) for mine in ways])) for name in ("tau_m", "tau_l"))
    return motor, load / run.ratio


def _all(run: Recording, name: str) -> np.ndarray:
    return np.concatenate([getattr(piece, name) for piece in run.pieces])
