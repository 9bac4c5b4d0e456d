"""A run that lies in several folders, copied or by a link: taken once, for it is no repeat of itself."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Protocol, TypeVar

Twice = Callable[[Path, str], object]
"""Told of a folder that is left out, and why."""


class Known(Protocol):
    """A run, however much of it was read; `uid` is "" where its manifest says none."""

    @property
    def uid(self) -> str: ...

    @property
    def path(self) -> Path: ...


T = TypeVar("T", bound=Known)


def passed_over(folder: Path, why: str) -> None:
    """For whom it is enough that every run comes once."""


def known_by(run: Known) -> str:
    """What no other run has: its uid, or its real place where it has none."""
    return f"uid {run.uid}" if run.uid else os.path.realpath(run.path)


class Seen:
    """Runs as they come, and whether one was there before; `twice` is told of such."""

    def __init__(self, twice: Twice = passed_over) -> None:
        self._first: dict[str, str] = {}
        self._twice = twice

    def is_new(self, run: Known) -> bool:
        """Whether `run` was not there yet."""
        known, here = known_by(run), str(run.path)
        first = self._first.get(known)
        if first is None:
            self._first[known] = here
            return True
        name = Path(first).name
        why = f"it is the same run as {first if name == run.path.name else name}"
        self._twice(run.path, f"{why} ({known})" if run.uid else why)
        return False


def once(found: Sequence[T], twice: Twice = passed_over) -> list[T]:
    """The first of `found` for each run."""
    seen = Seen(twice)
    return [run for run in found if seen.is_new(run)]


def links_last(folders: Sequence[Path]) -> list[Path]:
    """In the same order, but for links: of a run and a link to it the run comes first."""
    return sorted(folders, key=Path.is_symlink)
