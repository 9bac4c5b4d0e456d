"""Where an analysis broke off, kept in the run's folder: a sentence is for the operator, this for who mends it."""

from __future__ import annotations

from pathlib import Path

from rig.runfile.manifest import write_atomic

NAME = "analysis-error.txt"


def keep(folder: Path, trace: str) -> None:
    """`trace` in place of that of an analysis before; "" takes that away. Raises OSError."""
    if trace:
        write_atomic(folder / NAME, trace.encode(errors="replace"))
    else:
        (folder / NAME).unlink(missing_ok=True)
