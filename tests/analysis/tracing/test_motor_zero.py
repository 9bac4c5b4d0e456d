"""A slow run that counts the motor angle from another zero is told; one whose error differs otherwise is not."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.runs.campaign import read_campaign
from tests.analysis.tracing.spiked import Columns, change

RUNS = ["slow_ke_1", "slow_ke_2", "load_5nm_1"]
BY = np.deg2rad(114.6)


def one_in_three(law: Callable[[Columns], Columns]) -> Callable[[Columns, float], Columns]:
    began: list[float] = []

    def of(c: Columns, start: float) -> Columns:
        began.append(start)
        return law(c) if len(began) == 2 else {}  # of load_5nm_1, slow_ke_1 and slow_ke_2 the second

    return of


def shifted(c: Columns) -> Columns:
    return {"theta_m": c["theta_m"] + BY, "theta_l": c["theta_l"] + BY / 50}


def off_by_a_zero_of_the_load(c: Columns) -> Columns:
    return {"theta_l": c["theta_l"] + 0.3}


def with_a_larger_second_order(c: Columns) -> Columns:
    return {"theta_l": c["theta_l"] - 3e-4 * np.cos(2 * c["theta_m"] + 1.0)}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "told"), [(shifted, 1), (off_by_a_zero_of_the_load, 0), (with_a_larger_second_order, 0)]
)
def test_only_a_shift_of_all_orders_is_another_zero(
    law: Callable[[Columns], Columns], told: int, tmp_path: Path, shared: Path
) -> None:
    read = read_campaign(change(tmp_path, shared / "cases" / "open-1", one_in_three(law), RUNS))
    said = [note for note in read.notes if "from another zero than" in note]
    assert len(said) == told
    assert all(note.startswith("slow_ke_1: ") and "by 114.6" in note for note in said)
