"""The folder of temporary files, and what is said when it fails."""

from __future__ import annotations

import contextlib
import tempfile
from collections.abc import Iterator

from rig.core.errors import DataError


@contextlib.contextmanager
def room_for(what: str) -> Iterator[None]:
    """Turn an OSError of a temporary file into a sentence. Raises DataError: there is no room for `what` …"""
    try:
        yield
    except OSError as error:
        where = f" in {tempfile.tempdir}" if tempfile.tempdir else ""
        raise DataError(
            f"there is no room for {what} among the temporary files{where} ({error.strerror}); "
            "TMPDIR names another folder"
        ) from error
