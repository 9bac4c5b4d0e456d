"""Where an analysis broke off, kept in the run's folder: a sentence is for the operator, this for who mends it."""

from __future__ import annotations

import traceback
from pathlib import Path

from rig.runfile.manifest import write_atomic

NAME = "analysis-error.txt"
OUTSIDE = (OSError, MemoryError)  # of the machine; the others are defects of ours, for the run was read and analysed


def keep(folder: Path, trace: str) -> None:
    """`trace` in place of that of an analysis before; "" takes that away. Raises OSError."""
    if trace:
        write_atomic(folder / NAME, trace.encode(errors="replace"))
    else:
        (folder / NAME).unlink(missing_ok=True)


def broke_off(folder: Path, error: Exception) -> str:
    """The sentence of a run in `folder` whose report broke off with `error`; the traceback lies beside the run."""
    said = f"{type(error).__name__}: {error}"
    if isinstance(error, OUTSIDE):
        return f"its analysis broke off ({said})"
    try:
        keep(folder, "".join(traceback.format_exception(error)))
        where = f"; where it did stands in {folder / NAME}"
    except OSError as full:
        where = f"; where it did cannot be kept: {full.strerror or full}"
    return f"its analysis broke off on a defect of hdrig, please report it ({said}){where}"
