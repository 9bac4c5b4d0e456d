"""Runs without a time column that declare their speed: their rows have the seconds that it says."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.trace import trace
from tests.analysis.tracing.spiked import Columns, change

SPEEDS = ("60", "120", "200", "300", "400", "minus60", "minus200", "minus400")  # rpm
KINDS = ("slow_ke", "load_10nm", *(f"speed_{rpm}rpm" for rpm in SPEEDS))
NAMES = [f"{kind}_{k}" for kind in KINDS for k in (1, 2)]


def untimed(to: Path, shared: Path, drag: float = 0.0) -> Path:
    """Runs of an open campaign, dragged by so many N·m times the square of the motor's speed over 10 rad/s, and then
    without their time."""

    def law(c: Columns, began: float) -> Columns:
        omega = (c["theta_m"][-1] - c["theta_m"][0]) / (c["t"][-1] - c["t"][0])
        return {"tau_m": c["tau_m"] + drag * np.sign(omega) * (omega / 10.0) ** 2 * (abs(omega) > 3.0)}

    change(to, shared / "cases" / "open-1", law, NAMES)
    for run in to.iterdir():
        table = pq.read_table(run / "samples.parquet")
        pq.write_table(pa.table({n: table[n] for n in table.column_names if n != "t"}), run / "samples.parquet")
    return to


@pytest.mark.slow
def test_runs_that_declare_their_speed_are_clocked_by_it_and_others_are_not(tmp_path: Path, shared: Path) -> None:
    found = read_campaign(untimed(tmp_path, shared))
    assert {run.name for run in found.runs} == set(NAMES), "none is left out for what most others have"
    for run in found.runs:
        assert run.clocked is ("t" in run.has) is run.name.startswith("speed")
        if run.clocked:
            assert run.rate == pytest.approx(1000.0)
            assert run.turning == pytest.approx(run.speed_rpm * 2 * np.pi / 60, rel=0.05)
        else:
            assert run.turning < 0.5, "nothing that is slow is taken for fast"
    said = "16 runs declare the speed they turn at, by which their rows come 1000 times a second"
    assert any(said in note and "Of 4 others no seconds are known" in note for note in found.notes)


def test_speeds_that_do_not_agree_on_a_rate_clock_nothing(tmp_path: Path, shared: Path) -> None:
    folder = untimed(tmp_path, shared)
    for factor, run in enumerate(sorted(folder.glob("speed_*")), start=1):
        manifest = json.loads((run / "manifest.json").read_text())
        manifest["conditions"]["speed_rpm"] *= factor
        (run / "manifest.json").chmod(0o644)
        (run / "manifest.json").write_text(json.dumps(manifest))
    assert not any(run.clocked for run in read_campaign(folder).runs)


@pytest.mark.slow
@pytest.mark.long
def test_drag_is_named_without_a_time_column_where_speeds_are_declared(tmp_path: Path, shared: Path) -> None:
    found = trace(untimed(tmp_path, shared, drag=0.004))
    assert found.verdict.effects == ("quadratic_drag",)
    values = {p.name: p.value for p in found.effects[0].parameters}
    assert values["drag_at_10_rad_s"] == pytest.approx(0.004, rel=0.15)
