"""Rows without a time: taken for a thousand a second, as fast runs are logged."""

from __future__ import annotations

import shutil
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from rig.analysis.tracing.runs.record import record
from rig.analysis.tracing.runs.recording import Recording
from rig.runfile.run import Run


def untimed(run: Path, to: Path) -> Path:
    shutil.copytree(run, to)
    table = pq.read_table(run / "samples.parquet")
    pq.write_table(table.drop_columns(["t"]), to / "samples.parquet")
    return to


def read(run: Path) -> Recording:
    found = record(Run.open(run), 0.0)
    assert found is not None
    return found


def test_a_fast_run_without_a_time_is_smoothed_as_the_same_run_with_one(shared: Path, tmp_path: Path) -> None:
    run = shared / "cases" / "open-1" / "speed_400rpm_1"
    timed, not_timed = read(run), read(untimed(run, tmp_path / run.name))
    assert timed.rate == pytest.approx(1000.0, rel=1e-3)
    assert (not_timed.thinned, not_timed.smoother.half) == (timed.thinned, timed.smoother.half)
