"""A good run on disk in a tenth of a second: 24 turns there and back of the twin's gear, with a manifest like ours."""

from __future__ import annotations

import hashlib
import json
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from tests.analysis.synthetic import PROFILE

RATE = 200.0  # Hz: few rows, and still 125 a turn
SPEED = 2 * np.pi * 1.6  # rad/s, 96 rpm
UNITS = {
    "t": "s",
    "theta_m": "rad",
    "theta_l": "rad",
    "tau_m": "N·m",
    "tau_l": "N·m",
    "tau_ask": "N·m",
    "theta_ref": "rad",
}


def columns(seed: int = 1) -> dict[str, np.ndarray]:
    """Forth for 15 s, back for 15 s."""
    t = np.arange(0.0, 30.0, 1.0 / RATE)
    theta_ref = SPEED * (15.0 - np.abs(15.0 - t))
    noise = np.random.default_rng(seed).standard_normal((2, t.size))
    way = np.sign(15.0 - t)
    return {
        "t": t,
        "theta_m": theta_ref + 1e-4 * noise[0],
        "theta_l": theta_ref / 50.0 - PROFILE.value(theta_ref),
        "tau_m": 0.33 * way + 0.004 * noise[0],
        "tau_l": 1.02 * way + 0.03 * noise[1],
        "tau_ask": 0.33 * way,
        "theta_ref": theta_ref,
    }


def manifest() -> dict[str, Any]:
    """What a session writes, without the files."""
    return {
        "schema": "hdrig.run/1",
        "uid": "0123456789abcdef0123456789abcdef",
        "backend": "sim",
        "procedure": "kinematic_error",
        "status": "completed",
        "exit_reason": "the procedure came to its end",
        "started_utc": "2026-11-20T10:00:00.000000+00:00",
        "ended_utc": "2026-11-20T10:00:30.000000+00:00",
        "duration": 30.0,
        "clock": {"utc_at_start": "2026-11-20T10:00:00+00:00", "monotonic_at_start_ns": 1},
        "gear": {"serial": "A1", "ratio": 50.0, "output": "flexspline"},
        "declared": {"J_m": 1.1e-3, "J_l": 0.32, "K": 7160.0, "B_ml": 2.5e-3},
        "conditions": {"tau_ext": 0.0, "output_locked": False, "depth_mm": 0.0, "assembly": 1, "speed_rpm": 96.0},
        "encoders": {"motor_counts_per_rev": 10000, "load_counts_per_rev": 900000},
        "software": {"version": "0.1.0", "commit": "0" * 40, "dirty": False},
        "loop": {"rate": RATE, "clock": "virtual", "ticks": 6000},
        "proof": {"ratio": 49.99, "breakaway": 0.54},
    }


def made_run(folder: Path, change: dict[str, Any] | None = None, table: pa.Table | None = None) -> Path:
    """The run in `folder`; `change` replaces keys of the manifest, `table` the rows."""
    folder.mkdir(parents=True)
    noise = zlib.crc32(folder.name.encode())  # no two runs have one, or they would count once
    pq.write_table(rows(noise) if table is None else table, folder / "samples.parquet")
    data = (folder / "samples.parquet").read_bytes()
    files = {"samples.parquet": {"sha256": hashlib.sha256(data).hexdigest(), "bytes": len(data), "rows": 6000}}
    own = {"uid": hashlib.md5(str(folder).encode()).hexdigest()}  # no two runs have one
    about = {**manifest(), **own, "files": files, **(change or {})}
    (folder / "manifest.json").write_text(json.dumps(about))
    return folder


def rows(seed: int = 1) -> pa.Table:
    """The columns with their units, as Parquet has them."""
    made = columns(seed)
    fields = [pa.field(name, pa.float64(), metadata={"unit": unit}) for name, unit in UNITS.items()]
    return pa.table([pa.array(made[name]) for name in UNITS], schema=pa.schema(fields))
