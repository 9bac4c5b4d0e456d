"""Samples as Arrow columns: the schema with units and meanings, rows of the ring as batches, a batch's checksum."""

from __future__ import annotations

import zlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pyarrow as pa

from rig.core.channels import CHANNEL, CHANNELS
from rig.core.ring import NO_COUNTS
from rig.runfile.manifest import SCHEMA

Array = np.ndarray[Any, Any]

ANGLE_OF = {"counts_m": "theta_m", "counts_l": "theta_l"}  # a raw count without its angle was not measured
COMMANDED = {  # by the drive's mode, what the columns of torques are in truth: name, unit, meaning
    "velocity": {
        "tau_ask": ("omega_ask", "rad/s", "motor speed that was asked for"),
        "tau_applied": ("omega_applied", "rad/s", "motor speed the drive was really given"),
    },
    "position": {
        "tau_ask": ("theta_ask", "rad", "motor angle that was asked for"),
        "tau_applied": ("theta_applied", "rad", "motor angle the drive was really given"),
    },
}
_PLACE = {channel.name: i for i, channel in enumerate(CHANNELS)}
_TYPES = {"float64": pa.float64(), "int64": pa.int64(), "uint32": pa.uint32()}
_KINDS = tuple(_TYPES[channel.dtype] for channel in CHANNELS)


def schema_of(about: Mapping[str, Any]) -> pa.Schema:
    """The schema of the run a manifest is about: what was commanded is called by what it was."""
    called: Mapping[str, tuple[str, str, str]] = COMMANDED.get(about.get("loop", {}).get("mode", "torque"), {})
    layout = schema(about.get("backend", ""))
    for column, (name, unit, meaning) in called.items():
        place = layout.get_field_index(column)
        layout = layout.set(place, pa.field(name, pa.float64(), metadata={"unit": unit, "meaning": meaning}))
    return layout


def schema(backend: str, columns: dict[str, tuple[str, str]] | None = None) -> pa.Schema:
    """The Arrow schema of a run's samples; nothing in it tells two runs of one kind apart, so files compare.

    `columns` names those to have, each with (unit, meaning) for channels the table lacks; without it, the whole table.
    """
    names = columns if columns is not None else dict.fromkeys(CHANNEL, ("", ""))
    fields = []
    for name, (unit, meaning) in names.items():
        known = CHANNEL.get(name)
        kind, unit, meaning = (known.dtype, known.unit, known.meaning) if known else ("float64", unit, meaning)
        fields.append(pa.field(name, _TYPES[kind], metadata={"unit": unit, "meaning": meaning}))
    simulated = "true" if backend == "sim" else "false"
    return pa.schema(fields, metadata={"schema": SCHEMA, "backend": backend, "simulated": simulated})


def columns_of_rows(rows: Array) -> list[pa.Array]:
    """Rows of the ring, shape (n,), as columns. NaN, and counts that were not measured, become null.

    The bytes as they lie in memory. Not by pa.array: that looks for pandas first, and importing pandas costs more than
    recording a run.
    """
    n = len(rows)
    words = np.ascontiguousarray(rows).view(np.int64).reshape(n, len(CHANNELS))
    words = np.ascontiguousarray(words.T)  # (channels, n): every field of a row has 8 bytes
    absent = _not_measured(words)
    missing = absent.sum(axis=1).tolist()
    memory, size = pa.py_buffer(words), 8 * n  # taken hold of once for all columns
    values = [memory.slice(i * size, size) for i in range(len(CHANNELS) - 1)]
    values.append(pa.py_buffer(words[-1].astype(np.uint32)))  # flags, the last
    validity = [_bitmap(absent[i]) if count else None for i, count in enumerate(missing)]
    parts = zip(_KINDS, validity, values, missing, strict=True)
    return [pa.Array.from_buffers(kind, n, [there, v], count) for kind, there, v, count in parts]


def _bitmap(absent: Array) -> pa.Buffer:
    """What Arrow calls validity: a bit for each value that is there."""
    return pa.py_buffer(np.packbits(~absent, bitorder="little"))


def no_rows(layout: pa.Schema) -> list[pa.Array]:
    """The columns of `layout` without rows."""
    nothing = [None, pa.py_buffer(b"")]
    return [pa.Array.from_buffers(f.type, 0, nothing) for f in layout]


def _not_measured(words: Array) -> Array:
    """Which values of (channels, n) are null, same shape."""
    absent = np.isnan(words.view(np.float64))
    for count, angle in ANGLE_OF.items():
        absent[_PLACE[count]] = absent[_PLACE[angle]] | (words[_PLACE[count]] == NO_COUNTS)
    absent[_PLACE["flags"]] = False
    return np.asarray(absent)


def checksum(columns: Sequence[pa.Array], first: int) -> int:
    """CRC-32 over `first`, the index of the first row, then validity and values of every column."""
    crc, rows = zlib.crc32(b"%d" % first), len(columns[0])
    for column in columns if rows else ():
        validity, values = column.buffers()
        if column.null_count:
            crc = zlib.crc32(validity.slice(0, (rows + 7) // 8), crc)
        size = rows * column.type.byte_width  # behind it a file has padding
        crc = zlib.crc32(values if values.size == size else values.slice(0, size), crc)
    return crc


def as_float(column: pa.ChunkedArray) -> Array:
    """A column as float64, shape (n,), null as NaN; integers exact to 2**53. Raises pa.ArrowException for text.

    Chunk by chunk through DLPack: the column's own to_numpy looks for pandas first. Nothing is cast that need not be:
    to cast, Arrow imports all it can compute.
    """
    plain = column.type in _TYPES.values() and not column.null_count
    if plain:
        parts = [np.from_dlpack(chunk) for chunk in column.chunks]
    else:
        parts = [_null_as_nan(chunk) for chunk in column.cast(pa.float64(), safe=False).chunks]
    return np.concatenate([np.empty(0), *parts])  # a copy: the caller's own


def _null_as_nan(chunk: pa.Array) -> Array:
    """Numbers of float64, shape (n,). Not by fill_null: what it fills with looks for pandas too."""
    last = chunk.offset + len(chunk)
    validity, values = chunk.buffers()
    if values is None or chunk.null_count == len(chunk):
        return np.full(len(chunk), np.nan)
    found = np.frombuffer(values, np.float64, last)[chunk.offset :]
    if not chunk.null_count:
        return found
    there = np.unpackbits(np.frombuffer(validity, np.uint8), count=last, bitorder="little")[chunk.offset :]
    return np.where(there, found, np.nan)
