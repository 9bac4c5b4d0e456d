"""HDF5, through h5py. A column is the path of a dataset; of a matrix `path[j]`, of a compound one `path.field`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from rig.runfile.importing.mapping import Dialect
from rig.runfile.importing.table import Array, Table, locate

WIDEST = 256  # columns of a matrix offered one by one; what is wider is no table of channels


def read(path: Path, wanted: Sequence[str], dialect: Dialect) -> Table:
    """The wanted columns. Raises UsageError."""
    import h5py

    with h5py.File(path, "r") as file:
        offered = dict(columns(file, h5py))
        found = locate(offered, wanted, path.name)
        values = {name: offered[full][0]() for name, full in found.items()}
        units = {name: offered[full][1] for name, full in found.items() if offered[full][1]}
        simulated = bool(np.any(file.attrs.get("simulated", False)))  # as `hdrig export` writes it
    return Table(values, units, simulated=simulated)


def columns(file: Any, h5py: Any) -> Iterator[tuple[str, tuple[Callable[[], Array], str]]]:
    """(name, (how to read it, its unit)) of everything in the file that is a column."""
    datasets: list[Any] = []
    file.visititems(lambda _, item: datasets.append(item) if isinstance(item, h5py.Dataset) else None)
    for item in datasets:
        name, unit = item.name.strip("/"), _unit(item)
        if item.dtype.names:
            for field in item.dtype.names:
                yield f"{name}.{field}", (partial(_take, item, field), "")
        elif item.ndim == 2 and min(item.shape) > 1 and item.shape[1] <= WIDEST:
            for j in range(item.shape[1]):
                yield f"{name}[{j}]", (partial(_take, item, (slice(None), j)), unit)
        elif item.ndim and item.size == max(item.shape):
            yield name, (partial(_take, item, ()), unit)


def _take(item: Any, key: Any) -> Array:
    return np.asarray(item[key]).reshape(-1)


def _unit(item: Any) -> str:
    """The attribute `unit` or `units`, however it is spelt and stored."""
    for key in ("unit", "units", "Unit", "Units"):
        if key in item.attrs:
            found = item.attrs[key]
            found = found[0] if isinstance(found, np.ndarray) and found.size == 1 else found
            return found.decode("utf-8", "replace") if isinstance(found, bytes) else str(found)
    return ""
