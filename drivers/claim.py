"""One program at a time at a bus or a port: two loops at one motor would each undo what the other commands.

A file in a folder all users share, locked by `flock`: the kernel lets go of it with the process, however that ends, so
what a killed program leaves is a file that stops nobody. Its text only says who holds the lock.
"""

from __future__ import annotations

import contextlib
import fcntl
import logging
import os
import re
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, final

from rig.core.can_libraries import can
from rig.core.errors import NotReady

FOLDERS = (Path("/run/lock"), Path("/tmp"))  # the first that all users can write to: all have to mean the same
NAMED_BY = ("host", "port", "unique_hardware_id", "serial")  # options that make another bus of the same channel
LONGEST = 200  # bytes: of the text, and characters of a file's name
PRIVATE = ("virtual",)  # interfaces that do not leave the process


@final
class Claim:
    """Held from when it is made until `release`. Raises NotReady naming the process that holds `what` already."""

    def __init__(self, what: str) -> None:
        self._handle = _open(_folder() / f"hdrig-{re.sub(r'[^A-Za-z0-9.]+', '-', what)[-LONGEST:]}.lock")
        try:
            fcntl.flock(self._handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            holder = _read(self._handle)
            self.release()
            raise NotReady(
                f"{what} is in use by {holder}; one program at a time commands a bench: end that one first"
            ) from None
        with contextlib.suppress(OSError):  # a file of another user's: held all the same
            os.ftruncate(self._handle, 0)
            os.pwrite(self._handle, _myself().encode()[:LONGEST], 0)
            os.fchmod(self._handle, 0o666)  # whoever is next writes his own name into it

    def release(self) -> None:
        """Let go. Idempotent; never raises."""
        handle, self._handle = self._handle, -1
        if handle >= 0:
            os.close(handle)


def _folder() -> Path:
    return next((folder for folder in FOLDERS if folder.is_dir() and folder.stat().st_mode & 0o002), FOLDERS[-1])


def _open(path: Path) -> int:
    """The file, made where it is not there. No link is followed: the folder is everybody's. Raises NotReady."""
    flags = os.O_NOFOLLOW | os.O_CLOEXEC | os.O_NONBLOCK
    for more in (os.O_RDWR, os.O_RDWR | os.O_CREAT | os.O_EXCL, os.O_RDONLY):  # the last: another user's
        with contextlib.suppress(OSError):
            return os.open(path, flags | more, 0o644)
    raise NotReady(f"the lock file {path} cannot be opened: without it two programs could command one bench")


def _myself() -> str:
    program, *words = sys.argv
    since = time.strftime("%H:%M:%S UTC", time.gmtime())
    return f"process {os.getpid()} ({' '.join([Path(program).name, *words])[:120]}), since {since}"


def _read(handle: int) -> str:
    with contextlib.suppress(OSError):
        return os.pread(handle, LONGEST, 0).decode(errors="replace") or "another process"
    return "another process"


@final
class Alone:
    """What `can.Bus` makes, and the claim on its channel; both are let go by `shutdown`."""

    def __init__(self, bus: Any, claim: Claim) -> None:
        self._bus, self._claim = bus, claim
        self.send: Callable[..., None] = bus.send
        self.recv: Callable[..., can.Message | None] = bus.recv
        self.flush_tx_buffer: Callable[[], None] = bus.flush_tx_buffer
        self.fileno: Callable[[], int] = bus.fileno

    def shutdown(self) -> None:
        """Leave the bus, then let others at it."""
        try:
            self._bus.shutdown()
        finally:
            self._claim.release()


def connect_alone(interface: str, channel: str, **options: Any) -> Any:
    """`can.Bus`, refused where another process is on that channel. Raises NotReady, and what the backend raises."""
    logging.getLogger("can").setLevel(logging.CRITICAL)  # what matters of its log we say in sentences
    if interface in PRIVATE:
        return can.Bus(interface=interface, channel=channel, **options)
    claim = Claim(_name(interface, channel, options))
    try:
        return Alone(can.Bus(interface=interface, channel=channel, **options), claim)
    except BaseException:
        claim.release()
        raise


def _name(interface: str, channel: str, options: Mapping[str, Any]) -> str:
    """The same for every way to say the same: links to a path are followed."""
    if "/" in channel:
        return os.path.realpath(channel)
    return " ".join(["CAN", interface, channel, *(str(options[key]) for key in NAMED_BY if key in options)])


def claim_port(path: str) -> Claim:
    """A serial port for us alone. Raises NotReady."""
    return Claim(os.path.realpath(path))
