"""Weights that were hung have to be in the torques; one that was read from them says nothing of them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.runs.weights import refuse_odd_torques
from rig.core.errors import UsageError

BOTH = np.repeat([1.0, -1.0], 500)


def run(weight: float, hung: float, stated: bool = True) -> Any:
    """Goes both ways under `hung` N·m; `weight` N·m is what is known of it."""
    piece = SimpleNamespace(
        way=BOTH, tau_ext=np.full(BOTH.size, -weight), tau_l=hung + 0.4 * BOTH, tau_m=hung / 50 + 0.2 * BOTH, ratio=50.0
    )
    return SimpleNamespace(
        name=f"{weight:g}", locked=False, procedure="kinematic_error", pieces=(piece,), has={"tau_l", "tau_m"},
        load_stated=stated,
    )  # fmt: skip


def test_a_torque_that_does_not_follow_the_weights_is_refused() -> None:
    refuse_odd_torques([run(w, w) for w in (0.0, 5.0, 10.0)], "c")
    with pytest.raises(UsageError, match=r"τ_l changes by -1 N·m for every N·m of weight, expected about 1"):
        refuse_odd_torques([run(w, -w) for w in (0.0, 5.0, 10.0)], "c")


def test_a_weight_that_nobody_stated_and_the_torque_told_refuses_no_campaign() -> None:
    refuse_odd_torques([run(0.0, 5.0), run(5.0, 5.0, stated=False)], "c")
    with pytest.raises(UsageError):
        refuse_odd_torques([run(0.0, 5.0), run(5.0, 5.0)], "c")
