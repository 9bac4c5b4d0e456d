"""A parameter far from the declared one is said, with both numbers; one that is near, open or not declared is not."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing.outcome.unlike import unlike_declared
from rig.model.effect import parameter


def runs(*declared: dict[str, float]) -> Any:
    return [SimpleNamespace(declared=said) for said in declared]


def test_a_spring_less_than_half_as_stiff_as_declared_is_said() -> None:
    (said,) = unlike_declared([parameter("K", 3107.0, 8.0, "N·m/rad")], runs({"K": 7160.0}, {"K": 7160.0}))
    assert "K comes out as 3107 N·m/rad, 0.43 times the 7160 N·m/rad" in said


@pytest.mark.parametrize(
    ("value", "half", "declared"),
    [
        (7000.0, 10.0, [{"K": 7160.0}]),  # near
        (3107.0, 5000.0, [{"K": 7160.0}]),  # may be as declared
        (3107.0, 8.0, [{}]),  # not declared
        (3107.0, 8.0, [{"K": 7160.0}, {"K": 3000.0}]),  # runs do not agree
    ],
)
def test_what_is_near_open_or_not_declared_is_not(value: float, half: float, declared: list[dict[str, float]]) -> None:
    assert unlike_declared([parameter("K", value, half, "N·m/rad")], runs(*declared)) == []
