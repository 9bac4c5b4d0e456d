"""Some rows of a run, column by column, wherever they come from; what was not measured is NaN."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from rig.core.channels import CHANNEL, CHANNELS
from rig.runfile.columns import COMMANDED
from rig.runfile.run import Run

Array = np.ndarray[Any, Any]
FLOATS = tuple(c.name for c in CHANNELS if c.dtype == "float64")
LAYOUT = np.dtype([(c.name, "f8" if c.dtype == "float64" else "i8") for c in CHANNELS])


@dataclass(frozen=True)
class Block:
    """Rows in order of time: a field per channel of `rig.core.channels`, shape (n,)."""

    rows: Array

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, name: str) -> Array:
        """One channel, shape (n,)."""
        return np.asarray(self.rows[name])

    @property
    def t(self) -> Array:
        """s since the run's start, shape (n,)."""
        return self["t"]

    def slices(self, size: int) -> Iterator[Block]:
        """The same rows, at most `size` at a time."""
        for at in range(0, len(self.rows), max(size, 1)):
            yield Block(self.rows[at : at + size])


def of_ring(rows: Array, mode: str) -> Block:
    """Rows of a ring. A drive that closes a loop itself was asked for speeds or angles: those are no torques."""
    if mode in COMMANDED and len(rows):
        rows = rows.copy()
        for name in COMMANDED[mode]:
            rows[name] = np.nan
    return Block(rows)


def joined(blocks: list[Block]) -> Block:
    """Blocks that follow each other, as one."""
    return Block(np.concatenate([block.rows for block in blocks]))


LONGEST = 9e9  # s: the viewer counts ns in 64 bits; of longer runs nothing is known
FARTHEST = 1e12  # rad: a motor at 600 rpm would turn for 500 years; farther is no reading


def of_run(run: Run) -> Block:
    """A whole run folder, with a further field for every channel the table lacks.

    A run without time gets its row numbers as seconds.
    """
    others = [name for name in run.channels if name not in CHANNEL]
    rows = np.zeros(run.rows, np.dtype([*LAYOUT.descr, *((name, "f8") for name in others)]))
    for name in (*FLOATS, *others):
        found = run.column(name) if name in run.channels else None
        rows[name] = np.nan if found is None else found
    rows["flags"] = run.flags
    if not run.has("t"):
        rows["t"] = np.arange(run.rows) * 1.0
    for name in ("theta_m", "theta_l"):
        rows[name][~(np.abs(rows[name]) < FARTHEST)] = np.nan
    return Block(rows[np.abs(rows["t"]) < LONGEST])
