"""A run that lies in several folders, copied or by a link: taken once, for it is no repeat of itself. Nor are two whose
samples are the same to the last bit, as those of the twin are that began with one seed: they share their noise."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Final, Protocol, TypeVar

Twice = Callable[[Path, str], object]
"""Told of a folder that is left out, and why."""


class Known(Protocol):
    """A run, however much of it was read; `uid`, and the SHA-256 of its samples, "" where its manifest says none."""

    @property
    def uid(self) -> str: ...

    @property
    def path(self) -> Path: ...

    @property
    def digest(self) -> str: ...


T = TypeVar("T", bound=Known)
NOISE: Final = "which no repeat's are (the twin makes other noise with --seed N)"


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


def originals_first(found: Iterable[T]) -> Iterator[T]:
    """The runs as they come, but those last that look like copies: a folder that is not called by the run's uid, as
    ours are, then links; which of the folders of a run counts is the same for every verb by this."""
    later = []
    for run in found:
        if _is_called_by_uid(run) and not run.path.is_symlink():
            yield run
        else:
            later.append(run)
    yield from sorted(later, key=lambda run: (run.path.is_symlink(), str(run.path)))


def _is_called_by_uid(run: Known) -> bool:
    """A run without a uid is known by its place alone, and no copy."""
    return not run.uid or run.path.name.endswith(f"-{run.uid[:4]}")


def once(found: Sequence[T], twice: Twice = passed_over) -> list[T]:
    """Each run once, its original where that is among them, in the order in which they were first found."""
    seen = Seen(twice)
    taken = {known_by(run): run for run in originals_first(found) if seen.is_new(run)}
    return list(measured_once([taken[known] for known in dict.fromkeys(map(known_by, found))], twice))


def measured_once(found: Iterable[T], twice: Twice = passed_over) -> Iterator[T]:
    """Those whose samples are not to the last bit those of one before; `twice` is told of the others."""
    first: dict[str, Path] = {}
    for run in found:
        there = first.setdefault(run.digest, run.path) if run.digest else run.path
        if there is run.path:
            yield run
        else:  # of folders by date two may have one name
            name = there if there.name == run.path.name else there.name
            twice(run.path, f"its samples are those of {name} to the last bit, {NOISE}")
