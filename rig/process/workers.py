"""Work of one call shared by two processes.

Columns of one run are some hundred numpy calls of microseconds each: two threads spend half as much again handing the
interpreter's lock to each other. A forked copy of the process has all that was read already, takes every other piece
of the work, and leaves what it made in memory that both see.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
import gc
import mmap
import os
import pickle
import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import Any, Final, TypeVar

import pyarrow as pa

from rig.process.ctrl_c import deaf

T = TypeVar("T")
R = TypeVar("R")

WORKERS: Final = 2  # threads, where the work is long calls that leave the interpreter's lock; processes otherwise
MOST: Final = 16_384  # pieces of work: as many numbers as a pipe holds
ALIGNED: Final = 64  # bytes: a line of the cache
M_ARENA_MAX: Final = -8  # of malloc.h: how many heaps
HEAD: Final = 16  # bytes: where the table of results begins, and its size


def each(of: Callable[[T], R], items: Sequence[T]) -> list[R]:
    """`of` every item, in their order: whichever process is free takes the next. Large items first keep both busy.

    `of` must change nothing but what it returns. What the copy did not bring, for want of memory or because it raised,
    is made here: an error is raised as if there were no copy.
    """
    if len(items) < 2 or len(items) > MOST or not _may_fork():
        return [of(item) for item in items]
    source, drain = os.pipe()
    os.write(drain, b"".join(i.to_bytes(2, "little") for i in range(len(items))))
    os.close(drain)
    try:
        with _copy(lambda: ((i, of(items[i])) for i in _taken(source))) as copy:
            made = {i: of(items[i]) for i in _taken(source)}
            made |= copy()
    finally:
        os.close(source)
    return [made[i] if i in made else of(item) for i, item in enumerate(items)]


@contextlib.contextmanager
def meanwhile(of: Callable[[], R]) -> Iterator[Callable[[], R]]:
    """Have `of()` made while the block runs; what is given returns it, waiting if need be. As `each` otherwise."""
    if not _may_fork():
        yield of
        return
    with _copy(lambda: iter([(0, of())])) as copy:

        def result() -> R:
            made = copy()
            return made[0] if 0 in made else of()

        yield result


def first_that(of: Callable[[T], R | None], items: Sequence[T]) -> R | None:
    """The first that `of` makes of one of `items`, in their order; None where it makes none of any. While one is tried
    a copy tries the next: only whether there is something comes back, for what is made may hold half of all there is.
    """
    if not _may_fork():
        return next((made for item in items if (made := of(item)) is not None), None)
    for one, *after in (items[at : at + 2] for at in range(0, len(items), 2)):
        with meanwhile(functools.partial(_makes_any, of, after)) as makes_any:
            if (made := of(one)) is not None:
                return made  # the copy is gone with the block
            if makes_any():
                return of(*after)
    return None


def _makes_any(of: Callable[[T], R | None], items: Sequence[T]) -> bool:
    return any(of(item) is not None for item in items)


def one_heap() -> None:
    """All threads to come share the first one's: of heaps of their own each keeps what the others could use."""
    with contextlib.suppress(OSError, AttributeError):  # of glibc alone
        ctypes.CDLL(None).mallopt(M_ARENA_MAX, 1)


def give_back() -> None:
    """Memory that was freed, to the machine: the libraries keep it for what may come, and a copy would have it too."""
    pa.default_memory_pool().release_unused()  # what runs were read into
    with contextlib.suppress(OSError, AttributeError):  # of glibc alone
        ctypes.CDLL(None).malloc_trim(0)


def _may_fork() -> bool:
    """Not beside other threads: a lock that one of them holds would be held in the copy for ever."""
    return WORKERS > 1 and hasattr(os, "memfd_create") and threading.active_count() == 1


def _taken(source: int) -> Iterator[int]:
    """Numbers of pieces nobody took before, until there are none."""
    while number := os.read(source, 2):
        yield int.from_bytes(number, "little")


@contextlib.contextmanager
def _copy(work: Callable[[], Iterator[tuple[int, R]]]) -> Iterator[Callable[[], dict[int, R]]]:
    """A forked copy that does `work`; what is given waits for it and returns what it made. Gone when the block ends."""
    give_back()
    shared = os.memfd_create("trace")
    child = 0  # none, before and when it was waited for

    def brought() -> dict[int, R]:
        nonlocal child
        _, status = os.waitpid(child, 0)
        child = 0
        return _read(shared) if status == 0 else {}

    try:
        with deaf():  # an interrupt in the copy would unwind what is the main process's to end
            child = os.fork()
            if child == 0:
                _as_copy(work, shared)
        yield brought
    finally:
        if child:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
        os.close(shared)


def _as_copy(work: Callable[[], Iterator[tuple[int, R]]], shared: int) -> None:
    """Does not return: the copy must not run what stands behind the fork, nor write what buffers hold once more."""
    code = 1
    try:
        gc.disable()  # going through all objects would copy their pages
        _write(work(), shared)
        code = 0
    finally:
        os._exit(code)


def _write(made: Iterator[tuple[int, R]], shared: int) -> None:
    """Arrays one after the other as they are made, then how to put the results together again."""
    table: list[tuple[int, bytes, list[tuple[int, int]]]] = []
    at = HEAD
    with open(shared, "wb", closefd=False) as out:
        for number, result in made:
            buffers: list[pickle.PickleBuffer] = []
            rest = pickle.dumps(result, protocol=5, buffer_callback=buffers.append)
            places = []
            for buffer in buffers:
                at += -at % ALIGNED
                out.seek(at)
                with buffer.raw() as raw:
                    at += out.write(raw)
                    places.append((at - raw.nbytes, at))
            table.append((number, rest, places))
        out.seek(at)
        size = out.write(pickle.dumps(table))
        out.seek(0)
        out.write(at.to_bytes(8, "little") + size.to_bytes(8, "little"))


def _read(shared: int) -> dict[int, Any]:
    """What `_write` wrote; arrays lie in the shared memory itself, which lasts as long as one of them."""
    whole = memoryview(mmap.mmap(shared, 0, access=mmap.ACCESS_COPY))
    start, size = (int.from_bytes(whole[lo:hi], "little") for lo, hi in pairwise((0, HEAD // 2, HEAD)))
    table = pickle.loads(whole[start : start + size])
    return {i: pickle.loads(rest, buffers=[whole[lo:hi] for lo, hi in places]) for i, rest, places in table}
