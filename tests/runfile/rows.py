"""Samples known by their index alone, so that any prefix of a run can be checked to the last bit."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np

from rig.core.channels import CHANNELS, Flag
from rig.core.ring import Ring
from rig.core.sample import NAN, Sample
from rig.runfile.columns import columns_of_rows, schema
from rig.runfile.folder import create
from rig.runfile.journal import JournalWriter
from rig.runfile.run import Run

PERIOD = 1e-3  # s


def sample(i: int) -> tuple[Sample, float, float, float]:
    """Row `i` as the arguments of `put`. Some rows lack a torque, some a reference, some the load angle."""
    tau_l = NAN if i % 7 == 3 else 0.25 * (i % 101)
    theta_l, counts_l = (NAN, 0) if i % 11 == 5 else (i * 2e-4, 3 * i)
    flags = int(Flag.SIMULATED) | (int(Flag.STALE_TAU) if i % 7 == 3 else 0)
    kept = Sample(i * PERIOD, i * 0.01, theta_l, 10.0, -0.5 + i % 3, tau_l, 5e-5, i, counts_l, flags, "")
    return kept, 0.1 * (i % 13), 0.1 * (i % 13) - 1e-3, NAN if i % 2 else i * 0.01


def expected(n: int) -> dict[str, np.ndarray[Any, Any]]:
    """The columns of the first `n` rows, float64 with NaN where nothing was measured."""
    made = [sample(i) for i in range(n)]
    columns = {c.name: np.empty(n) for c in CHANNELS}
    for i, (kept, tau_ask, tau_applied, theta_ref) in enumerate(made):
        row = {**kept._asdict(), "tau_ask": tau_ask, "tau_applied": tau_applied, "theta_ref": theta_ref}
        if np.isnan(kept.theta_l):
            row["counts_l"] = NAN  # a count without its angle was not measured
        for name, column in columns.items():
            column[i] = row[name]
    return columns


def ring_of(n: int, capacity: int = 0) -> Ring:
    """A ring with the first `n` rows in it."""
    ring = Ring.create(capacity or max(n, 1))
    for i in range(n):
        ring.put(*sample(i))
    return ring


def new_folder(root: Path, **more: Any) -> Path:
    """A run folder of the twin, status running, made by a process that is dead."""
    gear = {"ratio": 50, "serial": "SN0042"}
    dead = {"process": {"pid": 0, "started": 0, "host": "nowhere"}}
    return create(
        root, "kinematic_error", {"backend": "sim", "gear": gear, **dead, **more}, "schema = 'hdrig.bench/1'\n"
    )


def write_journal(folder: Path, start: int, stop: int, batch: int = 50, close: bool = False) -> Path:
    """Rows start..stop in a new journal of `folder`, `batch` rows at a time."""
    ring = ring_of(stop)
    journal = JournalWriter(folder, schema("sim"), start)
    for first in range(start, stop, batch):
        journal.append(columns_of_rows(ring.read(first, min(first + batch, stop))))
    if close:
        journal.close()
    ring.unlink()
    ring.close()
    return journal.path


def assert_prefix(folder: Path, n: int) -> None:
    """The run holds exactly the first `n` rows, every channel to the last bit."""
    run = Run.open(folder)
    assert run.rows == n
    for name, values in expected(n).items():
        got = run.column(name)
        if got is None:
            assert np.isnan(values).all(), f"{name} is missing"
        else:
            np.testing.assert_array_equal(got, values, err_msg=name)


def manifest_of(folder: Path) -> dict[str, Any]:
    """The manifest as it is on disk."""
    return dict(json.loads((folder / "manifest.json").read_text()))


def copy_of(folder: Path, to: Path) -> Path:
    """The same folder elsewhere."""
    shutil.copytree(folder, to)
    return to
