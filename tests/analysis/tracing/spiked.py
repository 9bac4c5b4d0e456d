"""A measured campaign with something added to its columns."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Collection
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.trace import trace

Columns = dict[str, np.ndarray]
RATIO = 50
STIFFNESS = 7200.0  # N·m/rad, of the open campaigns


def spiked(
    to: Path, campaign: Path, law: Callable[[Columns, float], Columns], only: Collection[str] | None = None
) -> Trace:
    """A campaign, or some runs of it, traced with columns changed by `law`: see `change`."""
    return trace(change(to, campaign, law, only))


def change(
    to: Path, campaign: Path, law: Callable[[Columns, float], Columns], only: Collection[str] | None = None
) -> Path:
    """A campaign, or some runs of it, at `to`, with columns changed by `law`, which gets a run's columns and when it
    began [s]."""
    for run in sorted(p for p in campaign.iterdir() if p.is_dir() and (only is None or p.name in only)):
        began = started(run)
        table = pq.read_table(run / "samples.parquet")
        columns = {name: table[name].to_numpy() for name in table.column_names}
        shutil.copytree(run, to / run.name)
        changed = columns | law(columns, began)
        pq.write_table(pa.table(changed), to / run.name / "samples.parquet")
    return to


def started(run: Path) -> float:
    """When a run began, s."""
    manifest = json.loads((run / "manifest.json").read_text())
    return float(np.datetime64(manifest["started_utc"][:19]).astype(float))


def under(c: Columns, torque: np.ndarray) -> Columns:
    """With a torque [N·m] more on the output, which winds the gear up."""
    return {
        "tau_l": c["tau_l"] + torque,
        "theta_l": c["theta_l"] - torque / STIFFNESS,
        "tau_m": c["tau_m"] + torque / RATIO,
    }
