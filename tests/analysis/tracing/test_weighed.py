"""The inertia of a load whose angle nobody read is as declared, or what the fit knows of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit import learnt as module
from rig.analysis.tracing.fit.channels import BASELINE, INDEX
from rig.model.effect import Known
from rig.model.fourier import FourierSeries

BEFORE = Known(K=7000.0, B_sp=5.0, J_m=1e-3, J_l=0.8, kinematic_error=FourierSeries((1e-4,), (0.0,)))


def solution(J_l: float, has: set[str], declared: dict[str, float]) -> Any:
    x = np.full(len(BASELINE), 1e-4)
    x[INDEX["J_l"]] = J_l
    run = SimpleNamespace(has=has, declared=declared, gear=BEFORE, load_unread=False)
    eq = SimpleNamespace(runs=(run,), noise=SimpleNamespace(sigma={"L": 0.1}))
    values = dict(zip(BASELINE, x, strict=True))
    return SimpleNamespace(x=x, values=values, keys=(), design=SimpleNamespace(eq=eq))


@pytest.mark.parametrize(
    ("has", "declared", "sigma", "J_l"),
    [
        ({"theta_m", "theta_l"}, {"J_l": 0.8}, 0.5, 1.0),  # it was read: the fit tells
        ({"theta_m"}, {"J_l": 0.8}, 0.001, 0.8),  # too large, and sure of it
        ({"theta_m"}, {}, 0.01, 1.0),
        ({"theta_m"}, {}, 0.5, 0.8),
    ],
)
def test_who_tells_the_inertia(
    monkeypatch: pytest.MonkeyPatch, has: set[str], declared: dict[str, float], sigma: float, J_l: float
) -> None:
    monkeypatch.setattr(module, "scatter", lambda s: np.eye(len(BASELINE)) * sigma**2)
    assert module.learnt(solution(1.0, has, declared)).J_l == J_l
