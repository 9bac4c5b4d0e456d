"""MATLAB: v5 to v7 through scipy, v7.3 (which is HDF5) through h5py.

A column is a variable; of a struct `s.field`; of a matrix `M[j]`, j from 1 as in MATLAB. Cells, texts and objects
(table, timeseries) are left out: save them as plain arrays.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rig.runfile.importing.mapping import Dialect
from rig.runfile.importing.signatures import HDF5
from rig.runfile.importing.table import Array, Table, flat, locate

WIDEST = 256  # columns of a matrix offered one by one


def read(path: Path, wanted: Sequence[str], dialect: Dialect) -> Table:
    """The wanted columns. Raises UsageError."""
    with path.open("rb") as file:
        new = file.read(520)[512:] == HDF5  # v7.3 keeps the first 512 bytes for MATLAB's own header
    return _read_new(path, wanted) if new else _read_old(path, wanted)


def _read_old(path: Path, wanted: Sequence[str]) -> Table:
    from scipy.io import loadmat

    variables = loadmat(path, verify_compressed_data_integrity=True)
    offered = dict(c for name, v in variables.items() if not name.startswith("__") for c in _spread(name, v))
    found = locate(offered, wanted, path.name)
    return Table({name: offered[full] for name, full in found.items()}, {})


def _read_new(path: Path, wanted: Sequence[str]) -> Table:
    import h5py

    columns = {}
    with h5py.File(path, "r") as file:
        offered = dict(_datasets(file, h5py))
        for name, full in locate(offered, wanted, path.name).items():
            item, j = offered[full]
            columns[name] = np.asarray(item[()]).reshape(-1) if j is None else np.asarray(item[j])
    return Table(columns, {})


def _spread(name: str, value: Any) -> Iterator[tuple[str, Array]]:
    """The columns in one variable of scipy: the vector itself, the fields of a 1×1 struct, the columns of a matrix."""
    if not isinstance(value, np.ndarray):
        return
    if value.dtype.names:
        if value.size == 1:
            for field in value.dtype.names:
                yield from _spread(f"{name}.{field}", value.reshape(-1)[0][field])
    elif value.dtype.kind in "fiub" and (vector := flat(value)) is not None:
        yield name, vector
    elif value.dtype.kind in "fiub" and value.ndim == 2 and value.shape[1] <= WIDEST:
        yield from ((f"{name}[{j + 1}]", value[:, j]) for j in range(value.shape[1]))


def _datasets(file: Any, h5py: Any) -> Iterator[tuple[str, tuple[Any, int | None]]]:
    """(name, (dataset, row in it or None for all of it)): HDF5 holds MATLAB's matrices transposed."""
    datasets: list[Any] = []
    file.visititems(lambda _, item: datasets.append(item) if isinstance(item, h5py.Dataset) else None)
    for item in datasets:
        name = item.name.strip("/").replace("/", ".")
        kind = item.attrs.get("MATLAB_class", b"double")
        if name.startswith("#") or kind in (b"char", b"cell") or item.dtype.kind not in "fiub" or not item.ndim:
            continue
        if item.size == max(item.shape):
            yield name, (item, None)
        elif item.ndim == 2 and item.shape[0] <= WIDEST:
            yield from ((f"{name}[{j + 1}]", (item, j)) for j in range(item.shape[0]))
