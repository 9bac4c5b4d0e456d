"""A ring of fixed rows in shared memory: one producer, any number of readers, nobody ever waits for anybody.

A plain file in /dev/shm, mapped: it is there as long as nobody unlinks it, whichever processes are killed. A row
counts once `head` has passed it, and `head` is one aligned 8-byte store made after the row's own bytes (x86-64 keeps
that order for every reader; a machine with weaker order would need a barrier between the two). The recorder alone gives
room back, by moving `acked`; every other reader only looks, and `read` leaves out what it was too slow for.
"""

from __future__ import annotations

import contextlib
import json
import mmap
import os
import struct
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from rig.core.channels import CHANNELS
from rig.core.errors import RecorderError
from rig.core.regular import regular
from rig.core.sample import Sample

NO_COUNTS = -(2**63)  # a raw count that was not measured; null in the files. A count whose angle is NaN is null too
CAPACITY = 65_536  # rows: 65 s at 1 kHz, 6.8 MB
HEADER = 4096  # bytes before the first row: one page
SHARED = "/dev/shm"  # memory that outlives its processes; elsewhere a temporary file

_MAGIC, _VERSION = b"hdrigRNG", 1
_FIXED = struct.Struct("<8sIIQQQ")  # magic, version, bytes in a row, rows, pid of the producer, its start in ticks
_COUNTERS = slice(64, 192)  # 16 counters; the producer's and the recorder's lie on cache lines of their own
_HEAD, _CLOSED = 0, 1  # stored by the producer
_ACKED, _WRITTEN, _ERROR, _READER_PID, _READER_STARTED = 8, 9, 10, 11, 12  # stored by the recorder
_TEXT, _TEXT_MAX = 256, 1022  # the recorder's error: u16 length, then UTF-8
_TABLE = 1280  # the columns: u32 length, then JSON
_OWNER, _OWNER_MAX = 2304, 1790  # whose rows these are: u16 length, then JSON
_CODE = {"float64": "d", "int64": "q", "uint32": "q"}  # one 8-byte field each
_ROW = struct.Struct("".join(_CODE[c.dtype] for c in CHANNELS))  # native, aligned: the columns in the table's order
_DTYPE = {"d": "f8", "q": "i8"}


class Ring:
    """Rows of `rig.core.channels.CHANNELS`. `Ring.create` for the producer, `Ring.attach` for everybody else."""

    def __init__(self, path: Path, mapped: mmap.mmap) -> None:
        self.path = path
        self._mapped = mapped
        _, _, self._size, self.capacity, self.producer_pid, self.producer_started = _FIXED.unpack_from(mapped)
        self.columns: list[tuple[str, str]] = _read_columns(mapped)  # (name, dtype of the channel)
        self._view = memoryview(mapped)
        self._counters = self._view[_COUNTERS].cast("Q")
        layout = np.dtype([(name, _DTYPE[_CODE[dtype]]) for name, dtype in self.columns])
        self._rows: np.ndarray[Any, Any] = np.frombuffer(mapped, layout, count=self.capacity, offset=HEADER)
        self._pack = _ROW.pack_into
        self._head: int = self._counters[_HEAD]
        self._limit: int = self._counters[_ACKED] + self.capacity  # the producer looks again when it gets here

    @classmethod
    def create(cls, capacity: int = CAPACITY, started: int = 0, folder: Path | None = None) -> Ring:
        """A new ring of `capacity` rows, allocated and touched, so that no later store can fail or fault.

        `started` is when this process started, in clock ticks since boot (0 unknown), `folder` that of the run whose
        rows these are. Raises RecorderError.
        """
        path, mapped = _allocate(HEADER + capacity * _ROW.size)
        _FIXED.pack_into(mapped, 0, _MAGIC, _VERSION, _ROW.size, capacity, os.getpid(), started)
        table = json.dumps([(c.name, c.dtype) for c in CHANNELS]).encode()
        struct.pack_into(f"<I{len(table)}s", mapped, _TABLE, len(table), table)
        owner = _owner(folder) if folder else b""
        struct.pack_into(f"<H{len(owner)}s", mapped, _OWNER, len(owner), owner)
        return cls(path, mapped)

    @classmethod
    def attach(cls, path: Path | str, writable: bool = False) -> Ring:
        """An existing ring. Only the recorder asks for `writable`. Raises RecorderError when it is not a ring."""
        access = mmap.ACCESS_WRITE if writable else mmap.ACCESS_READ
        try:
            regular(path)
            with open(path, "r+b" if writable else "rb") as file:
                mapped = mmap.mmap(file.fileno(), 0, access=access)
        except (OSError, ValueError) as error:  # ValueError: an empty file
            raise RecorderError(f"{path} is not a ring of samples: {error}") from error
        _refuse_strangers(Path(path), mapped)
        return cls(Path(path), mapped)

    def put(self, sample: Sample, tau_ask: float, tau_applied: float, theta_ref: float) -> bool:
        """Add one row; False, and nothing is kept, when the recorder has not yet given the room back."""
        head = self._head
        if head >= self._limit:
            self._limit = self._counters[_ACKED] + self.capacity
            if head >= self._limit:
                return False
        t, theta_m, theta_l, omega_m, tau_m, tau_l, age, counts_m, counts_l, flags, _ = sample
        # fmt: off
        self._pack(
            self._mapped, HEADER + head % self.capacity * self._size,
            t, theta_m, theta_l, omega_m, tau_m, tau_l, tau_ask, tau_applied, theta_ref, age, counts_m, counts_l, flags,
        )
        # fmt: on
        self._head = self._counters[_HEAD] = head + 1
        return True

    def read(self, start: int, stop: int) -> np.ndarray[Any, Any]:
        """Rows `start` to `stop` (exclusive, counted from the first ever put), copied; shape (n,), a field per channel.

        Rows not there yet are left out at the end, rows already overwritten at the beginning: n tells.
        """
        start, stop = max(start, 0), min(stop, self.head)
        if stop - start > self.capacity:
            start = stop - self.capacity
        at, n = start % self.capacity, max(stop - start, 0)
        copy = np.concatenate((self._rows[at : at + n], self._rows[: max(at + n - self.capacity, 0)]))
        return copy[max(self.oldest - start, 0) :]

    @property
    def owner(self) -> str:
        """The folder of the run whose rows these are, as it was called at the start; "" when not said."""
        return str(self._said_owner().get("path", ""))

    def belongs_to(self, folder: Path) -> bool:
        """False when these are the rows of another folder, `folder` being a copy; one that was moved is the same."""
        said, here = self._said_owner(), json.loads(_owner(folder))
        return not said or any(said.get(key) == here[key] for key in said if key in here)

    def _said_owner(self) -> dict[str, Any]:
        (length,) = struct.unpack_from("<H", self._mapped, _OWNER)
        try:
            return dict(json.loads(self._mapped[_OWNER + 2 : _OWNER + 2 + length]))
        except ValueError:  # nothing was said
            return {}

    @property
    def head(self) -> int:
        """Rows put so far."""
        return int(self._counters[_HEAD])

    @property
    def oldest(self) -> int:
        """The first row that is surely still whole: what is not acked is never overwritten."""
        return int(max(0, min(self._counters[_ACKED], self._counters[_HEAD] - self.capacity + 1)))

    @property
    def acked(self) -> int:
        """Rows on disk: they survive a power cut."""
        return self._counters[_ACKED]

    @property
    def written(self) -> int:
        """Rows handed to the operating system: they survive the death of every process."""
        return self._counters[_WRITTEN]

    @property
    def closed(self) -> bool:
        """True when the producer will put no more."""
        return bool(self._counters[_CLOSED])

    @property
    def error(self) -> str:
        """What stopped the recorder, as a sentence; "" when nothing did."""
        if not self._counters[_ERROR]:
            return ""
        (length,) = struct.unpack_from("<H", self._mapped, _TEXT)
        return self._mapped[_TEXT + 2 : _TEXT + 2 + length].decode(errors="replace")

    @property
    def reader(self) -> tuple[int, int]:
        """The recorder's pid and its start in clock ticks since boot; zeros before there is one."""
        return self._counters[_READER_PID], self._counters[_READER_STARTED]

    def finish(self) -> None:
        """The producer's last word: no row follows."""
        self._counters[_CLOSED] = 1

    def tell_written(self, rows: int) -> None:
        """The recorder's word: `rows` are with the operating system."""
        self._counters[_WRITTEN] = rows

    def tell_acked(self, rows: int) -> None:
        """The recorder's word: `rows` are on disk, their room is free again."""
        self._counters[_ACKED] = rows

    def tell_reader(self, pid: int, started: int) -> None:
        """Who records. Clears the error of the one before."""
        self._counters[_ERROR], self._counters[_READER_PID], self._counters[_READER_STARTED] = 0, pid, started

    def tell_error(self, code: int, sentence: str) -> None:
        """The recorder's last word. `code` is an errno, or 1."""
        text = sentence.encode()[:_TEXT_MAX]
        struct.pack_into(f"<H{len(text)}s", self._mapped, _TEXT, len(text), text)
        self._counters[_ERROR] = code or 1

    def close(self) -> None:
        """Let go of the memory; the file stays. Idempotent."""
        self._rows = np.empty(0)
        self._counters.release()
        self._view.release()
        self._mapped.close()

    def unlink(self) -> None:
        """Remove the file. Whoever has it mapped keeps what is in it."""
        self.path.unlink(missing_ok=True)


def _owner(folder: Path) -> bytes:
    """A folder told apart from its copies, as JSON: by its path and, where it is moved later, by its inode."""
    said: dict[str, str | list[int]] = {}
    with contextlib.suppress(OSError):
        state = folder.stat()
        said["inode"] = [state.st_dev, state.st_ino]
    with_path = json.dumps(said | {"path": str(folder.absolute())}).encode()
    return with_path if len(with_path) <= _OWNER_MAX else json.dumps(said).encode()


def _allocate(size: int) -> tuple[Path, mmap.mmap]:
    """A file of `size` zero bytes, every page of it there, mapped for writing."""
    reasons = []
    for folder in (SHARED, tempfile.gettempdir()):
        try:
            return _allocate_in(folder, size)
        except OSError as error:
            reasons.append(f"{folder}: {error.strerror}")
    raise RecorderError(f"no room for {size / 1e6:.1f} MB of shared memory ({'; '.join(reasons)})")


def _allocate_in(folder: str, size: int) -> tuple[Path, mmap.mmap]:
    handle, name = tempfile.mkstemp(prefix="hdrig-", suffix=".ring", dir=folder)
    try:
        with open(handle, "r+b") as file:
            file.write(bytes(size))  # written, not only sized: a full tmpfs says so here and not by SIGBUS later
            file.flush()
            return Path(name), mmap.mmap(file.fileno(), size, flags=mmap.MAP_SHARED | getattr(mmap, "MAP_POPULATE", 0))
    except OSError:
        os.unlink(name)
        raise


def _read_columns(mapped: mmap.mmap) -> list[tuple[str, str]]:
    (length,) = struct.unpack_from("<I", mapped, _TABLE)
    return [(name, dtype) for name, dtype in json.loads(mapped[_TABLE + 4 : _TABLE + 4 + length])]


def _refuse_strangers(path: Path, mapped: mmap.mmap) -> None:
    """Raises RecorderError when the header is not that of a whole ring of this version."""
    if len(mapped) < HEADER or mapped[:8] != _MAGIC:
        raise RecorderError(f"{path} is not a ring of samples: it does not begin as one")
    _, version, size, capacity, _, _ = _FIXED.unpack_from(mapped)
    if version != _VERSION:
        raise RecorderError(f"{path} is a ring of version {version}, expected {_VERSION}")
    if len(mapped) != HEADER + size * capacity:
        raise RecorderError(f"{path} has {len(mapped)} bytes, expected {HEADER + size * capacity}")
    if _read_columns(mapped) != [(c.name, c.dtype) for c in CHANNELS]:
        raise RecorderError(f"{path} was made by a version of hdrig with other columns: read it with that one")
