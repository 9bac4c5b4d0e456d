"""A solution of runs that turn freely, each with a zero of its own."""

from __future__ import annotations

from collections.abc import Sequence
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor import offsets
from rig.model.effect import MEASURED

SOFT = 1.33e-4  # rad/(N·m)


def solution_of(
    monkeypatch: pytest.MonkeyPatch,
    module: ModuleType,
    zeros: Sequence[float] | np.ndarray,
    speeds: np.ndarray,
    torque: float,
    weights: np.ndarray | float = 0.0,
) -> tuple[Any, list[int], range]:
    """Of runs of 20 s, a minute apart, at those speeds [rad/s], with those zeros of θ̃ [rad] as `module` reads them;
    the fitted ones, and every third, unseen. `torque` [N·m per rad] is what the load's balance shows of the zeros,
    `weights` what hung on the output [N·m]."""
    times = 60.0 * np.arange(speeds.size)
    runs = [
        SimpleNamespace(
            locked=False,
            has=MEASURED,
            mean_torque=0.5 * np.sign(v),
            turning=abs(v),
            pieces=[SimpleNamespace(t=np.array([t, t + 20.0]), omega_m=np.full(2, v), tau_ext=np.full(2, w))],
        )
        for t, v, w in zip(times, speeds, np.broadcast_to(weights, speeds.shape), strict=True)
    ]
    eq = SimpleNamespace(runs=runs, rows={(i, c) for i in range(speeds.size) for c in "AL"})
    s = SimpleNamespace(design=SimpleNamespace(eq=eq, terms=()), value=lambda name: {"compliance": SOFT}[name])
    known = {"A": zeros, "L": torque * np.asarray(zeros)}
    for where, name in ((module, "zero"), (offsets, "offset")):
        monkeypatch.setattr(where, name, lambda _, run, channel: known[channel][run])
    unseen = range(1, speeds.size, 3)
    return s, [i for i in range(speeds.size) if i not in unseen], unseen
