"""How much room a run takes on disk, and whether it is there: asked before anything is energised."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from rig.core.channels import CHANNELS
from rig.core.errors import UsageError

SHARE = 1.4  # journal as it is, archive at about 0.4 of it; for a moment both are there
MARGIN = 1.25  # others write to the same disk meanwhile
BESIDE = 8e6  # bytes: events, report, result, and blocks that are not full


def rows_bytes(rows: float) -> float:
    """On disk, of a run while it is closed: the one rule for it."""
    return rows * 8 * len(CHANNELS) * SHARE


def free_under(folder: Path) -> int:
    """Bytes that are free on the disk of `folder`, which need not be there yet. Raises OSError."""
    there = folder
    while not os.path.lexists(there) and there != there.parent:
        there = there.parent
    try:
        return shutil.disk_usage(there).free
    except OSError as error:
        error.filename = str(there)
        raise


def refuse_no_room(folder: Path, rows: float, what: str) -> None:
    """Raises UsageError when the disk under `folder` has no room for `rows` rows of `what`."""
    try:
        free = free_under(folder)
    except OSError as error:
        raise UsageError(f"cannot see how much room {str(error.filename)[:200]} has: {error.strerror}") from None
    needed = MARGIN * rows_bytes(rows) + BESIDE
    if free < needed:
        raise UsageError(
            f"{str(folder)[:200]} has {free / 1e6:.1f} MB free, {what} needs up to {needed / 1e6:.1f} MB "
            f"({rows:.0f} rows, and what is made of them); make room, or name another place with --out"
        )
