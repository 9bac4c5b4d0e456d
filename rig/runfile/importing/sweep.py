"""What killed imports left, gone: each was a part of a copy, and hidden."""

from __future__ import annotations

import platform
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rig.core.errors import HdrigError
from rig.runfile.manifest import read
from rig.runfile.process import is_being_made

HIDDEN = "[0-9][0-9][0-9][0-9]-[0-9][0-9]-[0-9][0-9]/.[0-9][0-9][0-9][0-9]-*"


def sweep(root: Path) -> None:
    """Take away hidden folders of imports to `root` whose program is gone. What cannot be taken away stays."""
    for folder in root.glob(HIDDEN):
        try:
            about = read(folder)
        except (HdrigError, OSError):
            continue  # whose it is cannot be told
        if _is_left_over(about):
            shutil.rmtree(folder, ignore_errors=True)


def _is_left_over(about: Mapping[str, Any]) -> bool:
    """Of an import whose program ran on this machine: whether one of another machine lives cannot be seen."""
    process = about.get("process")
    ours = isinstance(process, dict) and process.get("host") == platform.node()
    return "import" in about and ours and not is_being_made(about)
