"""Of several runs a figure is drawn from the one that came nearest to its speed."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.reproduction.campaign import Campaign


def reading(meant: float, real: float, tau_ext: float = 0.0) -> Any:
    return SimpleNamespace(speed_rpm=meant, tau_ext=tau_ext, fast=SimpleNamespace(speed_rpm=real))


@pytest.mark.parametrize(("readings", "real"), [
    ([(310.0, 301.2), (310.0, 307.1), (300.0, 310.0)], 307.1),
    ([(math.nan, 309.0), (310.0, 301.2)], 301.2),  # what was meant goes first
    ([(math.nan, 306.0), (math.nan, 311.0), (math.nan, 350.0)], 311.0),
    ([(math.nan, 350.0), (300.0, 310.0)], None),
])  # fmt: skip
def test_the_run_nearest_to_the_speed_that_was_meant_is_taken(
    readings: list[tuple[float, float]], real: float | None
) -> None:
    campaign = Campaign([reading(*one) for one in readings] + [reading(310.0, 310.0, tau_ext=-5.0)], None)
    found: Any = campaign.at_speed(310.0)
    assert (None if found is None else found.fast.speed_rpm) == real
