"""What the mean of a torque does from day to day, runs of equal conditions compared: a zero that drifts, a gear that
runs in. Said where a channel is missing, for then a zero of every run's own hides it from the rest."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from rig.analysis.tracing.fit.channels import SENSOR_NAMES
from rig.analysis.tracing.outcome.ripple import DAY
from rig.analysis.tracing.runs.recording import Recording, read_by_any
from rig.core.quantiles import Z95
from rig.model.effect import MEASURED

FEWEST: Final = 3  # runs more than there are conditions: with fewer the scatter is not known
APART: Final = 1.0  # days between the first and the last


@dataclass(frozen=True)
class MeanDrift:
    """Of one torque: change of its mean a day, N·m, half its 95 % interval from the scatter, and the runs compared."""

    channel: str
    per_day: float
    half: float
    runs: int

    def document(self) -> dict[str, Any]:
        """For trace.json."""
        return {
            "channel": self.channel, "runs": self.runs, "per_day_Nm": {"value": self.per_day, "half95": self.half},
        }  # fmt: skip

    def sentence(self) -> str:
        """For people."""
        name, much = SENSOR_NAMES[self.channel], f"{1e3 * self.per_day:.3g} ± {1e3 * self.half:.2g} mN·m a day"
        return f"Mean of the {name}, {self.runs} runs, those of equal conditions compared: {much}."


def mean_drifts(runs: Sequence[Recording]) -> tuple[MeanDrift, ...]:
    """Of every torque that was measured over days, where a channel is missing; () elsewhere."""
    has = read_by_any(runs)
    if has >= MEASURED:
        return ()
    found = (_of(runs, channel) for channel in ("tau_l", "tau_m") if channel in has)
    return tuple(drift for drift in found if drift is not None)


def _of(runs: Sequence[Recording], channel: str) -> MeanDrift | None:
    alike: dict[str, list[tuple[float, float]]] = defaultdict(list)
    for run in runs:
        torque = np.concatenate([getattr(piece, channel) for piece in run.pieces])
        if channel in run.has and np.isfinite(torque).all():
            alike[run.said].append((run.start / DAY, float(torque.mean())))
    groups = [np.array(group) for group in alike.values() if len(group) > 1]
    if not groups:
        return None
    days, means = np.concatenate([group - group.mean(0) for group in groups]).T
    freedom = days.size - len(groups) - 1
    if freedom < FEWEST or np.ptp(np.concatenate([group[:, 0] for group in groups])) < APART or not days.any():
        return None
    slope = float(days @ means) / float(days @ days)
    scatter = float(np.sum((means - slope * days) ** 2)) / freedom
    return MeanDrift(channel, slope, float(Z95 * np.sqrt(scatter / (days @ days))), days.size)
