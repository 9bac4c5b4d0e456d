"""How a process ends that a person or a program waits for: one sentence on stderr and an exit code."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable

from rig.core.errors import Exit, HdrigError, with_notes


def ending_in_a_sentence(act: Callable[[], int]) -> int:
    """The exit code of `act`, or that of the error it ends with. Raises nothing but the SystemExit of `act`."""
    try:
        return act()
    except HdrigError as error:
        print(f"hdrig: {with_notes(error)}", file=sys.stderr)
        return int(error.exit)
    except KeyboardInterrupt:
        print("hdrig: interrupted", file=sys.stderr)
        return int(Exit.HALTED)
    except Exception as error:  # noqa: BLE001 - the way out: the drive is safe by now, the person gets a sentence
        if isinstance(error, PermissionError) and error.filename is not None:  # a place nobody may look into
            print(f"hdrig: {os.fsdecode(error.filename)} cannot be used: {error.strerror}", file=sys.stderr)
            return int(Exit.USAGE)
        if isinstance(error, FileNotFoundError) and _is_nowhere():
            print("hdrig: the current folder no longer exists; change to one that does", file=sys.stderr)
            return int(Exit.USAGE)
        print(f"hdrig: {internal(error)}", file=sys.stderr)
        return int(Exit.INTERNAL)


def internal(error: Exception) -> str:
    """The sentence of an error nobody foresaw."""
    return f"internal error, please report it: {_where(error)}"


def _is_nowhere() -> bool:
    """True when somebody removed the folder this process is in."""
    try:
        os.getcwd()
    except FileNotFoundError:
        return True
    return False


def _where(error: Exception) -> str:
    """Kind, text and place of an error nobody foresaw, on one line."""
    at = error.__traceback__
    while at is not None and at.tb_next is not None:
        at = at.tb_next
    place = f" in {at.tb_frame.f_code.co_filename}, line {at.tb_lineno}" if at is not None else ""
    text = " ".join(str(error).split())
    return f"{type(error).__name__}: {text[:200]}{place}"
