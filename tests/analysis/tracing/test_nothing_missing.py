"""Campaigns with nothing hidden, by the independent plant: nothing is said to be missing, whatever was not measured."""

import json
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.trace import trace
from tests.analysis.tracing.spiked import Columns, spiked, under
from tests.blind.cases import Request
from tests.blind.generate import write_case


@pytest.mark.long
@pytest.mark.parametrize("plan", ["no_torque_sensor", "one_direction"])
def test_nothing_is_missing_from_a_rig_that_is_the_papers(tmp_path: Path, plan: str) -> None:
    write_case(Request("clean", 5, plan), tmp_path, "case")
    verdict = trace(tmp_path / "case").verdict
    assert (verdict.status, verdict.effects) == (Status.NOTHING, ())


@pytest.mark.slow
def test_numbers_made_up_without_any_noise_have_nothing_hidden_in_their_rounding(tmp_path: Path) -> None:
    folder = tmp_path / "campaign" / "ramp"
    folder.mkdir(parents=True)
    told = {"schema": "hdrig.run/1", "procedure": "kinematic_error", "gear": {"ratio": 50}}
    (folder / "manifest.json").write_text(json.dumps(told))
    t = np.arange(0.0, 100.0, 0.004)
    theta = 25.13 * (1 - 2 * np.abs(2 * t / 100 - 1))
    still = np.ones(t.size)
    columns = {"t": t, "theta_m": theta, "theta_l": theta / 50, "tau_l": still, "tau_m": 0.1 * still}
    pq.write_table(pa.table(columns), folder / "samples.parquet")
    assert trace(tmp_path / "campaign").verdict.status == Status.NOTHING


@pytest.mark.long
@pytest.mark.parametrize(("height", "where"), [(0.16, "load_angle"), (0.0, None)])
def test_what_is_a_little_above_the_floor_is_said_where_one_coordinate_foretells_it(
    tmp_path: Path, shared: Path, height: float, where: str | None
) -> None:
    """A dent in the output's bearing, which brakes over 3 degrees of the output: 1.28 floors in the shaft torque."""
    names = [
        f"{kind}_{k}" for kind in ("slow_ke", "load_2.5nm", "load_10nm", "speed_60rpm", "speed_200rpm") for k in (1, 2)
    ]

    def dented(c: Columns, began: float) -> Columns:
        return under(c, height * np.exp(-0.5 * ((c["theta_l"] - 0.17) / 0.05) ** 2))

    found = spiked(tmp_path, shared / "cases" / "open-1", dented, names)
    assert (found.verdict.effects, found.verdict.coordinate) == ((), where)
    assert found.ratios_before["tau_l"] < 1.3
