"""What killed imports left, gone: each was a part of a copy, and hidden."""

from __future__ import annotations

import platform
import shutil
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rig.core.errors import HdrigError
from rig.runfile.manifest import read
from rig.runfile.process import is_being_made

HOUR = 3600.0  # s: naming a folder that is whole takes a moment
HIDDEN = "[0-9][0-9][0-9][0-9]-[0-9][0-9]-[0-9][0-9]/.[0-9][0-9][0-9][0-9]-*"


def sweep(root: Path) -> None:
    """Take away hidden folders of imports to `root` whose program is gone. What cannot be taken away stays."""
    for folder in root.glob(HIDDEN):
        try:
            about, age = read(folder), time.time() - folder.stat().st_mtime
        except (HdrigError, OSError):
            continue  # whose it is cannot be told
        if _is_left_over(about, age):
            shutil.rmtree(folder, ignore_errors=True)


def _is_left_over(about: Mapping[str, Any], age: float) -> bool:
    """Of an import whose program ran on this machine: whether one of another machine lives cannot be seen. Of one that
    was whole and not named yet nobody knows whose it is; last written to `age` s ago it is left over."""
    if about.get("status") == "completed":
        return "import" in about and age > HOUR
    process = about.get("process")
    ours = isinstance(process, dict) and process.get("host") == platform.node()
    return "import" in about and ours and not is_being_made(about)
