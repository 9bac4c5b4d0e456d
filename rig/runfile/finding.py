"""One thing found about a run."""

from __future__ import annotations

from typing import NamedTuple


class Finding(NamedTuple):
    """One thing found. `level` is "error" (a promise is broken), "warning" (look at it) or "note"."""

    level: str
    check: str
    sentence: str
