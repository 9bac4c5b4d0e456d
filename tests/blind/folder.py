"""Write run folders (format hdrig.run/1) with pyarrow alone: samples.parquet and manifest.json, nothing of ours."""

from __future__ import annotations

import hashlib
import json
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from tests.blind.plans import Plan, RunPlan
from tests.blind.rig import HARMONICS, NOMINAL_K, Rig
from tests.blind.sensors import LOAD_COUNTS, MOTOR_COUNTS
from tests.blind.taken import Taken

UNITS = {"t": "s", "theta_m": "rad", "theta_l": "rad", "tau_l": "N·m", "tau_m": "N·m", "temperature": "°C"}
MEANING = {
    "t": "time since the run's start, when the sample was latched",
    "theta_m": "motor (wave generator) angle, unwrapped",
    "theta_l": "load angle, unwrapped",
    "tau_l": "shaft torque sensor between gear output and load",
    "tau_m": "motor torque as the drive reports it",
    "temperature": "temperature of the torque sensor's housing",
}
RUN_FILES = ("samples.parquet", "manifest.json")  # what a tracer leaves beside them is no part of the campaign
FIRST_RUN = datetime(2026, 11, 3, 8, 0, 0, tzinfo=UTC)


def manifest(plan: RunPlan, rig: Rig) -> dict[str, object]:
    """What a stranger's logger writes beside the samples: declared numbers, conditions, encoders; no effects."""
    conditions: dict[str, object] = {"tau_ext": plan.tau_ext, "output_locked": plan.locked}
    if plan.procedure == "constant_torque":
        conditions["speed_rpm"] = int(plan.speed_rpm)
    started = FIRST_RUN + timedelta(seconds=plan.start_s + plan.lead_s)
    return {
        "schema": "hdrig.run/1",
        "procedure": plan.procedure,
        "backend": "imported",
        "status": "completed",
        "started_utc": started.isoformat(),
        "gear": {"ratio": round(rig.N), "output": "flexspline"},
        "declared": {"J_m": rig.J_m, "J_l": rig.J_l, "K": NOMINAL_K, "fourier_terms": HARMONICS},
        "conditions": conditions,
        "encoders": {"motor_counts_per_rev": MOTOR_COUNTS, "load_counts_per_rev": LOAD_COUNTS},
    }


def write_run(taken: Taken, folder: Path, channels: tuple[str, ...], rig: Rig) -> None:
    """One run folder."""
    folder.mkdir(parents=True)
    names = ["t", *(name for name in (*channels, "temperature") if name in taken.columns)]
    fields = [pa.field(n, pa.float64(), metadata={"unit": UNITS[n], "meaning": MEANING[n]}) for n in names]
    table = pa.table([taken.columns[n] for n in names], schema=pa.schema(fields))
    pq.write_table(table, folder / "samples.parquet", compression="zstd")
    text = json.dumps(manifest(taken.plan, rig), indent=1, ensure_ascii=False)
    (folder / "manifest.json").write_text(text, encoding="utf-8")


def write_campaign(runs: list[Taken], folder: Path, plan: Plan, rig: Rig) -> str:
    """All run folders below `folder`; returns the sha256 over every file, in order of path."""
    for taken in runs:
        write_run(taken, folder / taken.plan.name, plan.channels, rig)
    return digest(folder)


def digest(folder: Path) -> str:
    """sha256 over names and bytes of all files of the run folders below `folder`."""
    total = hashlib.sha256()
    for path in sorted(p for p in folder.glob("*/*") if p.name in RUN_FILES):
        total.update(str(path.relative_to(folder)).encode())
        total.update(path.read_bytes())
    return total.hexdigest()
