"""A column of time that no clock ever made."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.core.errors import UsageError
from rig.runfile.export import export
from rig.runfile.run import Run
from rig.runfile.verify import verify

T = np.arange(100) * 1e-3


def run_at(folder: Path, t: np.ndarray[tuple[int], np.dtype[np.float64]]) -> Path:
    about = {"schema": "hdrig.run/1", "procedure": "kinematic_error", "gear": {"ratio": 50}}
    (folder / "manifest.json").write_text(json.dumps(about))
    pq.write_table(pa.table({"t": t, "theta_m": T}), folder / "samples.parquet")
    return folder


@pytest.mark.parametrize("t", [T - 5.0, T + 1e300, T + 3e10], ids=["before the start", "never", "after 2554"])
def test_a_time_no_message_can_carry_is_refused_and_leaves_no_file(
    tmp_path: Path, t: np.ndarray[tuple[int], np.dtype[np.float64]]
) -> None:
    run = Run.open(run_at(tmp_path, t))
    with pytest.raises(UsageError, match=r"has a sample at t = .* s: an MCAP message lies between 1970 and 2554"):
        export(run, "mcap")
    assert not list(tmp_path.glob("*.mcap"))


def test_samples_of_infinite_time_are_left_out(tmp_path: Path) -> None:
    from mcap.reader import make_reader

    path = export(Run.open(run_at(tmp_path, np.where(T > 0.0795, np.inf, T))), "mcap")
    with open(path, "rb") as file:
        assert sum(1 for _ in make_reader(file).iter_messages()) == 80


def test_an_infinite_time_is_verified_without_a_warning(tmp_path: Path) -> None:
    folder = run_at(tmp_path, T + np.inf)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert not [f for f in verify(folder) if f.check == "gaps"]
