"""Errors a person reads: each is one sentence that says who, what, the number with its unit, and what was expected."""

from __future__ import annotations

import errno
from enum import IntEnum
from pathlib import Path
from typing import Final, TypeVar


class Exit(IntEnum):
    """Exit codes of every hdrig command."""

    PASS = 0
    OUT_OF_LIMITS = 1  # measured, and not good enough
    USAGE = 2  # the command line, a file or a configuration is wrong
    NOT_READY = 3  # a device is absent, a check failed, a calibration expired
    STOPPED = 4  # by the operator
    TRIPPED = 5  # by the guard
    INCOMPLETE = 6  # data incomplete, or the result is inconclusive
    INTERNAL = 70
    HALTED = 130  # second Ctrl-C


class HdrigError(Exception):
    """A sentence for the person at the rig, and the exit code of the command that ends with it."""

    exit = Exit.INTERNAL
    told = False  # in an event, to whoever reads those


class UsageError(HdrigError):
    """Something the operator wrote (option, file, key) cannot be meant as it stands."""

    exit = Exit.USAGE


class NotReady(HdrigError):
    """The rig is not in the state this act needs. Before a run nothing was moved; within one the torque
    is taken off."""

    exit = Exit.NOT_READY


class DataError(HdrigError):
    """A file is damaged or lacks what was asked of it."""

    exit = Exit.INCOMPLETE


class RecorderError(HdrigError):
    """Samples can no longer be kept."""

    exit = Exit.TRIPPED


E = TypeVar("E", bound=HdrigError)
SHUT: Final = (errno.EACCES, errno.EPERM, errno.EROFS)
"""What a system says of a place that this user may not read or write."""


def of_place(complaint: E, error: OSError) -> E:
    """`complaint`, made of `error`; it ends with USAGE where that is of a place that cannot be read or written, unless
    it ends a run that is being recorded."""
    if error.errno in SHUT and not isinstance(complaint, RecorderError):
        complaint.exit = Exit.USAGE
    return complaint


def with_notes(error: BaseException) -> str:
    """The sentence of `error` and what was added to it on its way: where what was recorded is, what may be on still."""
    return "; ".join([str(error), *getattr(error, "__notes__", [])])


def said_of(place: Path, error: HdrigError) -> str:
    """The sentence of `error`, to stand behind `place`: a path that it begins with is not said twice."""
    sentence = str(error)
    if sentence.startswith(f"{place}/"):
        return sentence.removeprefix(f"{place}/")
    return f"it {sentence.removeprefix(f'{place} ')}" if sentence.startswith(f"{place} ") else sentence


class Ended(HdrigError):
    """A run that others build on, or a question, was ended by the guard or the operator: its exit code is the
    command's."""

    def __init__(self, sentence: str, exit: Exit) -> None:
        super().__init__(sentence)
        self.exit = exit
