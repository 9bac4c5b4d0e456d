"""What is said where a file or folder cannot be written."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

from rig.core.errors import UsageError

LONGEST = 200  # characters


@contextlib.contextmanager
def writing(target: Path, option: str = "--out") -> Iterator[None]:
    """Turns an OSError into a UsageError: what cannot be written, why, and the option that names another place."""
    try:
        yield
    except OSError as error:
        why = error.strerror or str(error)
        raise UsageError(f"cannot write {_short(target)}: {why}; name another place with {option}") from None


def _short(target: Path) -> str:
    """A path that a line can hold."""
    return text if len(text := str(target)) <= LONGEST else f"{text[: LONGEST - 3]}..."
