"""Columns of any length: room for them, and the stretches of rows in which they are gone through."""

from __future__ import annotations

import mmap
import os
import tempfile
from collections.abc import Iterator
from typing import Any

import numpy as np

from rig.core.temporary import room_for

Array = np.ndarray[Any, np.dtype[np.float64]]

STRETCH = 1 << 16  # rows at a time: 512 KiB a column, which a core's cache holds
LONG = 1 << 20  # rows, 17 minutes at 1 kHz: a column of more takes more memory (8 MiB) than the program should hold


def room(rows: int) -> Array:
    """Room for a column, float64, shape (rows,), to be filled.

    A long one lies in a temporary file without a name, of which the machine keeps in memory what it likes: a run of ten
    hours then takes as much memory as one of ten minutes. Raises DataError where the disk has no room for it.
    """
    if rows <= LONG:
        return np.empty(rows)
    size = rows * 8
    with room_for(f"a column of {rows} rows, {size / 1e6:.0f} MB,"), tempfile.TemporaryFile() as file:
        os.posix_fallocate(file.fileno(), 0, size)  # now, in words: a page that finds no disk later kills us
        return np.frombuffer(mmap.mmap(file.fileno(), size), dtype=np.float64)


def stretches(rows: int) -> Iterator[slice]:
    """The rows 0..rows−1 in order, some at a time."""
    for start in range(0, rows, STRETCH):
        yield slice(start, min(start + STRETCH, rows))


def spread(rows: int, most: int) -> np.ndarray[Any, np.dtype[np.int64]]:
    """At most so many of the rows 0..rows−1, evenly over all of them: what is the same all along needs no more."""
    return np.unique(np.linspace(0, rows - 1, min(most, rows)).astype(np.int64))


def picked(column: Array, rows: np.ndarray[Any, np.dtype[np.int64]]) -> Array:
    """`column[rows]`."""
    out = room(rows.size)
    for some in stretches(rows.size):
        out[some] = column[rows[some]]
    return out
