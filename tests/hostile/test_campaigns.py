"""Campaigns nobody should trace: left out or refused in words, at once and without a warning of a library."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.analysis.tracing.campaign import read_campaign
from rig.core.errors import UsageError

Columns = dict[str, Any]


def columns() -> Columns:
    """12.6 turns of the motor in 10 s at 500 Hz."""
    t = np.arange(5000) / 500.0
    theta_m = 2 * np.pi * 1.26 * t
    noise = np.random.default_rng(1).normal(0.0, 1e-6, (4, t.size))
    theta_l = theta_m / 50 + 2e-4 * np.cos(2 * theta_m) + noise[0]
    return {"t": t, "theta_m": theta_m, "theta_l": theta_l, "tau_m": 0.3 + noise[1], "tau_l": 1.0 + noise[2]}


def campaign(root: Path, change: Callable[[Columns], Columns], runs: int = 2) -> Path:
    """Run folders of another logger whose columns went through `change`."""
    for number in range(runs):
        folder = root / f"run-{number}"
        folder.mkdir(parents=True)
        about = {"schema": "hdrig.run/1", "procedure": "constant_torque", "gear": {"ratio": 50}}
        (folder / "manifest.json").write_text(json.dumps(about))
        pq.write_table(pa.table(change(columns())), folder / "samples.parquet")
    return root


def first(n: int) -> Callable[[Columns], Columns]:
    return lambda c: {name: x[:n] for name, x in c.items()}


def times(name: str, factor: float) -> Callable[[Columns], Columns]:
    return lambda c: {**c, name: c[name] * factor}


def test_the_campaign_these_are_made_from_can_be_read(tmp_path: Path) -> None:
    assert len(read_campaign(campaign(tmp_path, lambda c: c)).runs) == 2


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (first(0), "it has 0 rows, expected at least 50"),
        (first(1), "it has 1 rows, expected at least 50"),
        (first(10), "it has 10 rows, expected at least 50"),
        (times("t", 1000.0), "it has one row every 2 s, expected one in 0.2 s at most"),
        (lambda c: {name: x[::500] for name, x in c.items()}, "it has 10 rows"),
        (lambda c: {"t": ["a", "b"], "theta_m": ["x", "y"]}, "holds string, expected numbers"),
    ],
    ids=["no row", "one row", "ten rows", "time in ms", "1 Hz", "text"],
)
def test_what_cannot_be_traced_is_refused_with_the_reason(
    tmp_path: Path, change: Callable[[Columns], Columns], said: str
) -> None:
    with pytest.raises(UsageError, match=r"none of its 2 runs can be used: run-0 was left out: .*") as caught:
        read_campaign(campaign(tmp_path, change))
    assert said in str(caught.value)


def test_one_hostile_run_among_good_ones_is_left_out_by_name(tmp_path: Path) -> None:
    campaign(tmp_path, lambda c: c)
    campaign(tmp_path / "other", first(10), 1)
    (tmp_path / "other/run-0").rename(tmp_path / "short")
    found = read_campaign(tmp_path)
    assert [run.name for run in found.runs] == ["run-0", "run-1"]
    assert any(note.startswith("short was left out: it has 10 rows") for note in found.notes)
