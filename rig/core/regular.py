"""Regular files only: to open a pipe, a socket or a device is to wait for somebody who may never come."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path

KINDS = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a named pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)


def regular(path: Path | str) -> os.stat_result:
    """What the system knows of the regular file at `path`, links followed.

    Raises OSError: absent, or of which other kind it is; ValueError for what can be no name (a zero byte).
    """
    found = os.stat(path)
    if not stat.S_ISREG(found.st_mode):
        kind = next((word for is_kind, word in KINDS if is_kind(found.st_mode)), "something else")
        raise OSError(errno.EINVAL, f"it is {kind}, expected a regular file", str(path))
    return found
