"""Campaigns nobody should trace: left out or refused in words, at once and without a warning of a library."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.analysis.tracing.runs.campaign import read_campaign
from rig.core.errors import DataError, UsageError

Columns = dict[str, Any]


def columns(seed: int = 1) -> Columns:
    """12.6 turns of the motor in 10 s at 500 Hz; of another `seed` the noise is another."""
    t = np.arange(5000) / 500.0
    theta_m = 2 * np.pi * 1.26 * t
    noise = np.random.default_rng(seed).normal(0.0, 1e-6, (4, t.size))
    theta_l = theta_m / 50 + 2e-4 * np.cos(2 * theta_m) + noise[0]
    return {"t": t, "theta_m": theta_m, "theta_l": theta_l, "tau_m": 0.3 + noise[1], "tau_l": 1.0 + noise[2]}


def campaign(root: Path, change: Callable[[Columns], Columns], runs: int = 2, **said: Any) -> Path:
    """Run folders of another logger whose columns went through `change`; `said` goes into the manifest."""
    for number in range(runs):
        seed = sum(str(root).encode()) + number  # no two runs have the same noise
        folder = root / f"run-{number}"
        folder.mkdir(parents=True)
        about = {"schema": "hdrig.run/1", "procedure": "constant_torque", "gear": {"ratio": 50}, **said}
        (folder / "manifest.json").write_text(json.dumps(about))
        pq.write_table(pa.table(change(columns(seed))), folder / "samples.parquet")
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
        (first(1), "it has 1 row, expected at least 50"),
        (first(10), "it has 10 rows, expected at least 50"),
        (times("t", 1000.0), "it has one row every 2 s, expected one every 1e-06 to 0.2 s"),
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


def test_a_campaign_of_damaged_files_alone_is_damaged(tmp_path: Path) -> None:
    for samples in campaign(tmp_path, lambda c: c).glob("*/samples.parquet"):
        samples.write_bytes(samples.read_bytes()[:-1000])
    with pytest.raises(DataError, match="none of its 2 runs can be used"):
        read_campaign(tmp_path)


def test_one_hostile_run_among_good_ones_is_left_out_by_name(tmp_path: Path) -> None:
    campaign(tmp_path, lambda c: c)
    campaign(tmp_path / "other", first(10), 1)
    (tmp_path / "other/run-0").rename(tmp_path / "short")
    found = read_campaign(tmp_path)
    assert [run.name for run in found.runs] == ["run-0", "run-1"]
    assert any(note.startswith("short was left out: it has 10 rows") for note in found.notes)


@pytest.mark.parametrize("odd", ["word", [1], {"a": 1}, float("nan"), 1e300, 10**400, True, -1], ids=str)
def test_numbers_of_a_manifest_that_are_none_count_as_not_said(tmp_path: Path, odd: Any) -> None:
    tables = {"declared": {"K": odd, "J_m": odd}, "conditions": {"tau_ext": odd}}
    counts = {"encoders": {"motor_counts_per_rev": odd, "load_counts_per_rev": odd}, "sample_rate_hz": odd}
    assert len(read_campaign(campaign(tmp_path, lambda c: c, **tables, **counts)).runs) == 2


def test_readings_no_sensor_gives_count_as_missing(tmp_path: Path) -> None:
    found = read_campaign(campaign(tmp_path, times("tau_l", 1e300)))
    assert not any("tau_l" in run.has for run in found.runs)
    assert any(n.startswith("run-0: 5000 values of tau_l are absurdly large: taken as") for n in found.notes)


@pytest.mark.parametrize("ratio", [1e300, 1e-300])
def test_a_ratio_no_gear_has_is_refused(tmp_path: Path, ratio: float) -> None:
    with pytest.raises(UsageError, match=r"gear\.ratio is 1e.*, expected 0\.001 to 100000"):
        read_campaign(campaign(tmp_path, lambda c: c, gear={"ratio": ratio}))


def test_what_was_left_out_is_named_whatever_was_wrong_with_it(tmp_path: Path) -> None:
    folder = campaign(tmp_path, lambda c: c, runs=6)
    names = sorted(path.name for path in folder.iterdir())
    torn, empty, garbled, nameless = (folder / name for name in names[:4])
    (torn / "samples.parquet").write_bytes((torn / "samples.parquet").read_bytes()[:1000])
    pq.write_table(pq.read_table(empty / "samples.parquet").slice(0, 0), empty / "samples.parquet")
    (garbled / "manifest.json").write_text("{")
    (nameless / "manifest.json").unlink()
    found = read_campaign(folder)
    assert found.left_out == tuple(names[:4])
    assert {run.name for run in found.runs} == set(names[4:])


def test_a_lock_test_said_to_be_free_is_taken_for_locked_and_said_to_be(tmp_path: Path) -> None:
    at_rest = {"procedure": "stiffness_lock", "conditions": {"output_locked": False}}
    found = read_campaign(campaign(tmp_path, lambda c: {**c, "theta_l": 0.0 * c["theta_l"]}, **at_rest))
    assert all(run.locked for run in found.runs)
    assert any("its output is taken for locked" in note for note in found.notes)


def test_a_run_whose_samples_are_no_longer_those_it_was_closed_with_is_read_and_said_to_be(tmp_path: Path) -> None:
    campaign(tmp_path, lambda c: c, 3)
    for run, changed in ((tmp_path / "run-0", False), (tmp_path / "run-1", True)):
        about = json.loads((run / "manifest.json").read_text())
        digest = hashlib.sha256((run / "samples.parquet").read_bytes()).hexdigest()
        about["files"] = {"samples.parquet": {"sha256": "0" * 64 if changed else digest}}
        (run / "manifest.json").write_text(json.dumps(about))
    found = read_campaign(tmp_path)
    assert [run.name for run in found.runs] == ["run-0", "run-1", "run-2"]
    said = "samples.parquet is not the file this run was closed with (its SHA-256 differs)"
    assert [note.split(":")[0] for note in found.notes if said in note] == ["run-1"]
