"""Paths that are text: the library that reads and writes samples takes no others."""

from __future__ import annotations

import os
from pathlib import Path

from rig.core.errors import UsageError


def refuse_no_text(folder: Path, option: str = "") -> None:
    """Raises UsageError for a path, given by `option`, with bytes in it that are no UTF-8."""
    whole = os.path.abspath(folder)
    try:
        whole.encode()
    except UnicodeEncodeError:
        shown = whole.encode("utf-8", "backslashreplace").decode()
        raise UsageError(f"{option} {shown}: expected a path in UTF-8".lstrip()) from None
