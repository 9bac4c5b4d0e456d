"""Parquet, through pyarrow. Units: field metadata `unit`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rig.runfile.importing.mapping import Dialect
from rig.runfile.importing.table import Array, Table, locate
from rig.runfile.origin import says_simulated


def read(path: Path, wanted: Sequence[str], dialect: Dialect) -> Table:
    """The wanted columns. Raises UsageError."""
    import pyarrow.parquet as pq

    with pq.ParquetFile(path, page_checksum_verification=True) as file:
        schema = file.schema_arrow
        found = locate(schema.names, wanted, path.name)
        table = file.read(columns=list(found.values()))
        columns = {name: to_numpy(table[full]) for name, full in found.items()}
    simulated = says_simulated(schema.metadata)  # a run folder's own samples say it
    units = {name: (schema.field(full).metadata or {}).get(b"unit", b"") for name, full in found.items()}
    stated = {name: unit.decode("utf-8", "replace") for name, unit in units.items() if unit}
    return Table(columns, stated, simulated=simulated)


def to_numpy(column: Any) -> Array:
    """An Arrow column as numpy: null is NaN (NaT in dates), decimals are floats, dates are in ns, text stays text."""
    import pyarrow as pa
    import pyarrow.compute as pc

    kind = column.type
    if pa.types.is_dictionary(kind):
        return to_numpy(column.cast(kind.value_type))
    if pa.types.is_timestamp(kind):
        return np.asarray(column.cast(pa.timestamp("ns", kind.tz)).to_numpy(), dtype="datetime64[ns]")
    if pa.types.is_decimal(kind) or pa.types.is_boolean(kind) or pa.types.is_null(kind):
        return np.asarray(pc.cast(column, pa.float64()).to_numpy(), dtype=np.float64)
    return np.asarray(column.to_numpy())
