"""What a page draws: columns in the units of people, from rows of the ring or a reading while nothing runs.

What was asked of the drive is none of them: of a drive that closes a loop itself the ring's columns of torques hold
speeds or angles.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np

from rig.core.units import ARCSEC, DEG, RPM
from rig.model.transmission_error import transmission_error

MAGIC, VERSION = 0x48445247, 1
HEADER = struct.Struct("<IHHII")  # magic, version, columns, rows, skipped

COLUMNS: tuple[tuple[str, str], ...] = (
    ("motor_angle", "deg"),
    ("speed", "rpm"),  # of the motor
    ("tau_m", "N·m"),
    ("tau_l", "N·m"),
    ("following", "deg"),  # reference minus motor angle
    ("kinematic_error", "arcsec"),  # θ_m/N − θ_l, from its value at the start
)
Rows = np.ndarray[Any, Any]
LAYOUT = np.dtype([("t", "f8"), *((name, "f8") for name, _ in COLUMNS)])


def of_run(rows: Rows, ratio: float, zero: float) -> Rows:
    """Rows of a ring, shape (n,), as columns for people; `zero` rad is θ_m/N − θ_l at the run's start."""
    out = np.empty(len(rows), LAYOUT)
    theta_m = rows["theta_m"]
    out["t"] = rows["t"]
    out["motor_angle"] = theta_m / DEG
    out["speed"] = rows["omega_m"] / RPM
    out["tau_m"], out["tau_l"] = rows["tau_m"], rows["tau_l"]
    out["following"] = (rows["theta_ref"] - theta_m) / DEG
    out["kinematic_error"] = (transmission_error(theta_m, rows["theta_l"], ratio) - zero) / ARCSEC
    return out


def of_reading(reading: Mapping[str, Any]) -> Rows:
    """One reading while nothing runs, shape (1,). What nobody asked for or measured is NaN."""
    theta_m, _, omega_m, tau_m, tau_l, _ = (math.nan if x is None else float(x) for x in reading["row"])
    out = np.full(1, math.nan, LAYOUT)
    out["t"], out["motor_angle"] = float(reading["t"]), theta_m / DEG
    out["speed"], out["tau_m"], out["tau_l"] = omega_m / RPM, tau_m, tau_l
    return out


def frame(block: Rows, skipped: int) -> bytes:
    """A binary frame: header, float64 t, then float32 column after column."""
    parts = [HEADER.pack(MAGIC, VERSION, len(COLUMNS), len(block), skipped), block["t"].astype("<f8").tobytes()]
    parts += [block[name].astype("<f4").tobytes() for name, _ in COLUMNS]
    return b"".join(parts)
