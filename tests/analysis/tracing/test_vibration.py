"""A vibration is named where it swells too, though one wave of constant size leaves half of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.outcome.result import Status
from tests.analysis.tracing.spiked import Columns, spiked, under

CARRIER, SWELL, SIZE = 4.1, 0.31, 0.25  # Hz, Hz, N·m: well below the resonance at 15 Hz


def swelling(c: Columns, began: float) -> Columns:
    t = c["t"] + began
    return under(c, SIZE * (1 + 0.9 * np.sin(2 * np.pi * SWELL * t)) * np.sin(2 * np.pi * CARRIER * t))


@pytest.mark.slow
@pytest.mark.long
def test_a_vibration_that_swells_is_named_with_its_lines(tmp_path: Path, shared: Path) -> None:
    found = spiked(tmp_path, shared / "cases" / "open-1", swelling)
    assert found.verdict.status == Status.EXPLAINED
    assert found.verdict.effects == ("external_vibration",)
    values = {p.name: p.value for p in found.effects[0].parameters}
    assert values["frequency"] == pytest.approx(CARRIER, abs=0.01)
    assert values["torque_amplitude"] == pytest.approx(SIZE, rel=0.1)
    assert sorted(values[f"frequency_{i}"] for i in (2, 3)) == pytest.approx(
        [CARRIER - SWELL, CARRIER + SWELL], abs=0.02
    )
