"""The mean of a torque from day to day: given back, and not made up of conditions that differ."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.outcome.mean_drift import MeanDrift, mean_drifts
from rig.analysis.tracing.outcome.ripple import DAY

LOADS = (0.0, 10.0, 20.0)


def run(rng: np.random.Generator, day: float, load: float, per_day: float) -> Any:
    """Rows of a shaft torque that drifts, with a load that has a mean of its own."""
    torque = load + per_day * day + 0.01 * rng.standard_normal() + 0.1 * rng.standard_normal(100)
    piece = SimpleNamespace(tau_l=torque)
    return SimpleNamespace(has=frozenset({"theta_m", "tau_l"}), pieces=(piece,), start=day * DAY, said=f"{load:g}")


def test_a_mean_that_drifts_is_given_back_whatever_the_load(rng: np.random.Generator) -> None:
    # later days carry more: the drift must not be read from that
    runs = [run(rng, day, load, 0.05) for day in range(6) for load in LOADS if load <= 5 * day]
    (found,) = mean_drifts(runs)
    assert found.per_day == pytest.approx(0.05, abs=2 * found.half)
    assert found.half < 0.01
    assert f"{1e3 * found.per_day:.3g} ± " in found.sentence()
    assert "mN·m a day" in found.sentence()


def test_runs_of_one_day_or_taken_once_say_nothing(rng: np.random.Generator) -> None:
    assert mean_drifts([run(rng, 0.1 * i, load, 0.05) for i in range(5) for load in LOADS]) == ()
    assert mean_drifts([run(rng, float(i), 5.0 * i, 0.05) for i in range(5)]) == ()


def test_with_all_channels_the_rest_says_more(rng: np.random.Generator) -> None:
    runs = [run(rng, float(i), 1.0, 0.05) for i in range(5)]
    for one in runs:
        one.has = frozenset({"theta_m", "theta_l", "tau_m", "tau_l", "t"})
    assert mean_drifts(runs) == ()


def test_the_document_has_the_numbers_of_the_sentence() -> None:
    d = MeanDrift("tau_l", 0.02, 0.001, 9)
    assert d.document() == {"channel": "tau_l", "runs": 9, "per_day_Nm": {"value": 0.02, "half95": 0.001}}
    assert d.sentence() == "Mean of the shaft torque, 9 runs, those of equal conditions compared: 20 ± 1 mN·m a day."
