"""Inertia and friction at the motor from torque steps: two slopes of speed, two unknowns."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rig.core.errors import DataError
from rig.core.quantiles import Z95

Array = npt.NDArray[np.float64]
SKIP = 0.005  # s after each switch: the drive's torque loop and one tick of delay
STEP = 0.9  # of the highest torque: what is less is no step, but the nudge before them
COAST = 0.06  # s of the run-out used: long enough for the slope, short enough to stay above the Stribeck speed


class StepResponse(NamedTuple):
    """Seen at the motor, means over all steps; of the friction also the standard deviation of a single step."""

    inertia: float  # kg·m²
    friction: float  # N·m, while coasting
    friction_scatter: float
    steps: int

    @property
    def sentence(self) -> str:
        """For the operator. The steps repeat better than the method is true: the load swings on the gear's spring."""
        half = Z95 * self.friction_scatter / self.steps**0.5
        return (
            f"inertia at the motor {self.inertia:.3g} kg·m² (within 5 %: the load hangs on the gear's spring), "
            f"friction while coasting {self.friction:.3f} ± {half:.3f} N·m, viscous part included, "
            f"{self.steps} torque steps"
        )


def step_response(t: Array, theta_m: Array, tau: Array) -> StepResponse:
    """J = τ/(ω̇_on − ω̇_off) and τ_f = −J·ω̇_off, each in the direction of the step.

    `t` s, `theta_m` rad, `tau` the torque applied N·m, all shape (n,). Raises DataError when no step moved the motor.
    """
    inertia, friction = [], []
    for begin, end in _pulses(tau):
        sign = np.sign(tau[begin])
        on = _acceleration(t, sign * theta_m, t[begin] + SKIP, t[end])
        off = _acceleration(t, sign * theta_m, t[end] + SKIP, t[end] + SKIP + COAST)
        if on - off <= 0 or on <= 0:
            continue
        J = float(abs(np.mean(tau[begin:end])) / (on - off))
        inertia.append(J)
        friction.append(-J * off)
    if len(inertia) < 2:
        raise DataError(
            f"the torque steps of {np.max(np.abs(tau)):.3g} N·m moved the motor {len(inertia)} times, "
            "expected at least 2: is it blocked?"
        )
    return StepResponse(
        float(np.mean(inertia)), float(np.mean(friction)), float(np.std(friction, ddof=1)), len(inertia),
    )  # fmt: skip


def _pulses(tau: Array) -> list[tuple[int, int]]:
    """Index pairs [begin, end) of the stretches with torque on."""
    on = np.concatenate(([0], (np.abs(tau) > STEP * np.max(np.abs(tau))).astype(int), [0]))
    edges = np.diff(on)
    return list(zip(np.flatnonzero(edges == 1).tolist(), np.flatnonzero(edges == -1).tolist(), strict=True))


def _acceleration(t: Array, theta: Array, begin: float, end: float) -> float:
    """ω̇ [rad/s²] of a parabola through the angles between two times."""
    window = (t >= begin) & (t <= end)
    if np.count_nonzero(window) < 5:
        return 0.0
    return float(2 * np.polyfit(t[window] - begin, theta[window], 2)[0])
