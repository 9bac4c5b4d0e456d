"""What hangs on the output is told by the mean of both directions, which friction leaves alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from rig.analysis import analyse
from tests.analysis.synthetic import TURN, MadeRun, triangle

FRICTION = 0.8  # N·m at the torque sensor, with the direction


def told(weight: float, declared: object, one_way: bool = False, zero: float = 0.0) -> str:
    """What a run says of a weight [N·m] that hangs on the output, where `declared` is said to."""
    t = np.arange(0.0, 60.0, 0.01)
    theta_m = 0.5 * TURN * t if one_way else triangle(t, 4 * TURN, 1 / 60)
    tau_l = FRICTION * np.sign(np.gradient(theta_m, t)) - weight + zero
    columns = {"t": t, "theta_m": theta_m, "theta_l": theta_m / 50, "tau_l": tau_l}
    manifest: dict[str, Any] = {"procedure": "kinematic_error", "conditions": {"tau_ext": declared}}
    return "".join(s for s in analyse(MadeRun(columns, manifest)).cannot if s.startswith("What hangs"))


def test_a_weight_that_nobody_declared_is_told_with_its_size_and_sign() -> None:
    assert "+5.00 N·m in the mean of both directions (positive drives the load forward)" in (said := told(5.0, 0.0))
    assert "the manifest says 0 N·m" in said
    assert "−5.00 N·m" in told(-5.0, 0.0)


def test_the_other_weight_and_the_other_sign_are_told() -> None:
    assert "shows +10.00 N·m" in (said := told(10.0, 20.0))
    assert "says +20 N·m" in said
    assert told(-20.0, 20.0)


@pytest.mark.parametrize(("weight", "declared", "zero"), [(5.0, 5.0, 0.0), (0.0, 0.0, 0.3), (40.0, 38.5, 0.2)])
def test_what_is_declared_and_a_sensor_a_little_off_zero_are_no_news(
    weight: float, declared: float, zero: float
) -> None:
    assert not told(weight, declared, zero=zero)


def test_one_direction_says_nothing_of_a_weight() -> None:
    assert not told(5.0, 0.0, one_way=True)
