"""One little run of a foreign logger, written in every format that can be imported."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

ROWS, N = 400, 50
COUNTS_M, COUNTS_L = 4096, 1_296_000
UNITS = {"time": "ms", "motor": "counts", "load": "deg", "torque": "mN·m", "temperature": "°C"}

MAPPING = """
schema = "hdrig.import/1"
procedure = "kinematic_error"
[gear]
ratio = 50
serial = "SN7"
[channels.t]
column = "time"
unit = "ms"
[channels.theta_m]
column = "motor"
unit = "counts"
counts_per_turn = 4096
bits = 16
[channels.theta_l]
column = "load"
unit = "deg"
sign = -1
[channels.tau_l]
column = "torque"
unit = "mN·m"
[channels.temperature]
column = "temperature"
unit = "°C"
meaning = "housing"
"""

Columns = dict[str, np.ndarray[Any, Any]]


def truth() -> Columns:
    """The run as it should come out: t [s], theta_m and theta_l [rad], tau_l [N·m], counts_m, temperature [°C]."""
    t = np.arange(ROWS) * 0.002 + np.random.default_rng(1).uniform(0, 2e-4, ROWS)
    t -= t[0]
    counts = np.round(700 + 20 * COUNTS_M * (t / t[-1])).astype(np.int64)
    theta_m = counts * (2 * np.pi / COUNTS_M)
    tau_l = 3.0 * np.sin(9.0 * t)
    theta_l = theta_m / N - tau_l / 20_000.0
    temperature = np.round(25 + t, 3)
    return {
        "t": t,
        "theta_m": theta_m,
        "theta_l": theta_l,
        "tau_l": tau_l,
        "counts_m": counts,
        "temperature": temperature,
    }


def columns() -> Columns:
    """The same as the foreign logger wrote it: 16-bit counter, ms since switched on, deg, mN·m, load reversed."""
    run = truth()
    return {
        "time": run["t"] * 1e3 + 5000.0,
        "motor": run["counts_m"] % 2**16,
        "load": np.degrees(-run["theta_l"]),
        "torque": run["tau_l"] * 1e3,
        "temperature": run["temperature"],
    }


def write_csv(path: Path, data: Columns, delimiter: str = ",", decimal: str = ".", encoding: str = "utf-8") -> None:
    rows = zip(*(c.tolist() for c in data.values()), strict=True)
    cells = [delimiter.join(str(value).replace(".", decimal) for value in row) for row in rows]
    lines = [delimiter.join(data), *cells]
    path.write_text("\n".join(lines) + "\n", encoding=encoding)


def write_parquet(path: Path, data: Columns) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    fields = [pa.field(n, pa.array(v).type, metadata={"unit": UNITS.get(n, "")}) for n, v in data.items()]
    pq.write_table(pa.table([pa.array(v) for v in data.values()], schema=pa.schema(fields)), path)


def write_mat(path: Path, data: Columns) -> None:
    from scipy.io import savemat

    savemat(path, {n: v.reshape(-1, 1) for n, v in data.items()}, do_compression=True)


def write_mat_new(path: Path, data: Columns) -> None:
    """As MATLAB writes v7.3: its own header in the first 512 bytes, arrays transposed, the class in an attribute."""
    import h5py

    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in data.items():
            file.create_dataset(name, data=values.reshape(1, -1)).attrs["MATLAB_class"] = np.bytes_("double")
    with open(path, "r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Fri Nov 20 2026".ljust(124) + b"\x00\x02IM")


def write_hdf5(path: Path, data: Columns) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        for name, values in data.items():
            file.create_dataset(f"rig/{name}", data=values).attrs["unit"] = UNITS.get(name, "")


def write_mdf(path: Path, data: Columns) -> None:
    from asammdf import MDF, Signal

    with MDF(version="4.10") as file:
        seconds = data["time"] * 1e-3  # the master channel, which the library calls "time" and keeps in s
        signals = [Signal(v, seconds, name=n, unit=UNITS.get(n, "")) for n, v in data.items() if n != "time"]
        file.append(signals, comment="rig")
        file.save(path, overwrite=True)


def write_tdms(path: Path, data: Columns) -> None:
    from nptdms import ChannelObject, TdmsWriter

    with TdmsWriter(path) as file:
        file.write_segment([ChannelObject("rig", n, v, {"unit_string": UNITS.get(n, "")}) for n, v in data.items()])


def mapping_for(name: str) -> str:
    """The mapping of the run in this file."""
    return MAPPING.replace('unit = "ms"', 'unit = "s"') if name == "run.mf4" else MAPPING


WRITERS = {
    "run.csv": write_csv,
    "run.parquet": write_parquet,
    "run.mat": write_mat,
    "run-v7.3.mat": write_mat_new,
    "run.h5": write_hdf5,
    "run.mf4": write_mdf,
    "run.tdms": write_tdms,
}
