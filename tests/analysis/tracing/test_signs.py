"""A sensor the wrong way round is refused by its name; anything else is not."""

from __future__ import annotations

import shutil
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.runs.units import odd_angles
from rig.core.errors import UsageError

RUNS = ("slow_ke_1", "slow_ke_2", "load_10nm_1", "load_10nm_2", "speed_200rpm_1", "speed_200rpm_2")
SENSORS = {
    ("tau_m", -1.0): "N·τ_m changes by -",
    ("tau_l", -1.0): "τ_l changes by -",
    ("tau_l", 1000.0): "N·m for every N·m of weight",
    ("theta_l", -1.0): "θ_l goes -",
    ("theta_m", 57.3): "goes 0.01745 of θ_m/50, expected 1",
}
UNLOADED = {"tau_m": "friction of the motor comes out negative", "tau_l": "τ_l seems to have the other sign"}


def spoilt(name: str, factor: float, to: Path, shared: Path, runs: tuple[str, ...] = RUNS) -> Path:
    """A few runs of the first open campaign with one channel times `factor`."""
    for run in runs:
        shutil.copytree(shared / "cases" / "open-1" / run, to / run)
        path = to / run / "samples.parquet"
        table = pq.read_table(path)
        at = table.schema.get_field_index(name)
        table = table.set_column(at, name, pa.array(factor * table[name].to_numpy()))
        pq.write_table(table, path)
    return to


@pytest.mark.slow
@pytest.mark.parametrize(("name", "factor"), SENSORS)
def test_a_wrong_sign_or_unit_is_refused_by_name(name: str, factor: float, tmp_path: Path, shared: Path) -> None:
    with pytest.raises(UsageError, match=SENSORS[name, factor]):
        prepare(read_campaign(spoilt(name, factor, tmp_path, shared)), ())


@pytest.mark.slow
@pytest.mark.parametrize("name", UNLOADED)
def test_a_wrong_sign_shows_without_any_weight_too(name: str, tmp_path: Path, shared: Path) -> None:
    unloaded = tuple(run for run in RUNS if "load" not in run)
    with pytest.raises(UsageError, match=UNLOADED[name]):
        prepare(read_campaign(spoilt(name, -1.0, tmp_path, shared, unloaded)), ())


@pytest.mark.slow
def test_sensors_that_agree_are_not(tmp_path: Path, shared: Path) -> None:
    assert prepare(read_campaign(spoilt("tau_m", 1.0, tmp_path, shared)), ()).baseline.value("J_l") > 0


def test_a_standstill_turns_nothing_and_is_not_asked_to() -> None:
    run: Any = SimpleNamespace(locked=False, procedure="standstill", has=frozenset({"theta_m", "theta_l"}))
    assert odd_angles(run) is None
