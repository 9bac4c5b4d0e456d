"""What a manifest declares of the gear, however it is written."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing.runs.declared import UNKNOWN, believed


@pytest.mark.parametrize(
    ("declared", "stiffness"),
    [
        ({"K": 9000.0}, 9000.0),
        ({"K": {"value": 9000.0, "unit": "N·m/rad", "origin": "assumed"}}, 9000.0),
        ({"K": "9000"}, UNKNOWN.K),
        ({"K": {"unit": "N·m/rad"}}, UNKNOWN.K),
        ({"K": 0.0}, UNKNOWN.K),
        ({}, UNKNOWN.K),
    ],
)
def test_a_declared_stiffness_may_have_its_unit_beside_it(declared: dict[str, Any], stiffness: float) -> None:
    run: Any = SimpleNamespace(declared=declared)
    found = believed(run).K
    assert found == stiffness
