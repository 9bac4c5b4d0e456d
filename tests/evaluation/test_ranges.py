"""A torque larger than the bench beside the run can measure or give is in another unit, and settles nothing."""

from __future__ import annotations

import tracemalloc
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pytest

from rig.evaluation.ranges import beyond_ranges
from rig.evaluation.run import analyse_folder
from tests.commands.made_run import made_run, rows

pytestmark = pytest.mark.usefixtures("no_pictures")

BENCH = """
[motor]
torque_limit = { value = 5.0, unit = "N·m", from = "assumed" }
[torque_sensor]
range = 50.0
"""


def scaled(name: str, factor: float) -> pa.Table:
    table = rows()
    i = table.schema.get_field_index(name)
    return table.set_column(i, table.schema.field(i), pc.multiply(table[name], factor))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("tau_l", "N·m, the torque sensor's range is 50 N·m (torque_sensor.range of the bench beside it): another"),
        ("tau_m", "N·m, the motor's limit is 5 N·m (motor.torque_limit of the bench beside it): another unit than"),
    ],
)
def test_a_torque_in_mNm_is_a_check_that_is_not_met(tmp_path: Path, name: str, words: str) -> None:
    folder = made_run(tmp_path / "run", {"limits": {"kinematic_error_peak_to_peak": 1.0}}, scaled(name, 1e3))
    (folder / "bench.toml").write_text(BENCH)
    result, _ = analyse_folder(folder, folder)
    told = next(check for check in result.checks if check.name == "within_range")
    assert (result.verdict, told.passed) == ("INCONCLUSIVE", False)
    assert told.sentence.startswith(f"{name} reaches ")
    assert words in told.sentence
    assert told.sentence in result.sentence
    assert "within_range" in (folder / "result.json").read_text()


@pytest.mark.slow
@pytest.mark.parametrize(("bench", "factor"), [(BENCH, 1.0), ("", 1e3), ("[torque_sensor]\nrange = 'wide'", 1e3)])
def test_nothing_is_said_of_torques_in_range_or_of_a_bench_that_says_none(
    tmp_path: Path, bench: str, factor: float
) -> None:
    folder = made_run(tmp_path / "run", None, scaled("tau_l", factor))
    if bench:
        (folder / "bench.toml").write_text(bench)
    assert "within_range" not in [check.name for check in analyse_folder(folder, folder)[0].checks]


def test_the_torque_of_a_long_run_is_looked_at_in_little_memory() -> None:
    torque = np.full(3_000_000, 1e3)
    torque[:10] = np.nan
    run: Any = SimpleNamespace(column=lambda name: torque if name == "tau_l" else None)
    tracemalloc.start()
    try:
        assert "tau_l reaches 1000 N·m" in beyond_ranges(run, {"torque_sensor": {"range": 50.0}})
        assert tracemalloc.get_traced_memory()[1] < 3e6  # bytes; a copy of the column has 24e6
    finally:
        tracemalloc.stop()
