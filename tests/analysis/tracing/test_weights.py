"""Weights that were hung have to be in the torques; one read from them says nothing of them; another is told."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.runs.weights import other_weights, refuse_odd_torques
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


def test_another_weight_than_stated_is_told_of_its_run_alone() -> None:
    fine = [run(w, w + 0.2) for w in (0.0, 5.0, 10.0, 40.0)]
    assert other_weights(fine) == []
    (said,) = other_weights([*fine, run(0.0, 5.2)])
    assert (said.run, said.became) == ("0", "")
    assert "shows -5 N·m" in said.reason
    assert "manifest 0 N·m" in said.reason


def test_a_zero_that_all_runs_have_is_no_weight_and_friction_is_none_either() -> None:
    assert other_weights([run(w, w + 3.0) for w in (0.0, 5.0, 10.0)]) == []
    cut = run(0.0, 0.0)
    cut.pieces[0].way, cut.pieces[0].tau_l = BOTH[:800], 20.0 * BOTH[:800]  # a triangle that was cut short
    assert other_weights([cut]) == []
    still = run(0.0, 5.0)
    still.pieces[0].way = 0.0 * BOTH
    assert other_weights([still]) == []


def test_a_weight_that_was_not_stated_is_not_another_one() -> None:
    assert other_weights([run(5.0, 9.0, stated=False)]) == []
