"""Lines of text in order, more of them than the memory should hold: sorted in pieces, which a temporary file keeps."""

from __future__ import annotations

import heapq
import os
import pickle
import tempfile
from collections.abc import Iterable, Iterator
from itertools import islice
from operator import itemgetter
from typing import IO, Any

from rig.core.temporary import room_for

PIECE = 1000  # lines sorted at once; as few as that never see a file
BACK = 20  # lines of each piece read back at a time

Keyed = tuple[Any, str]  # what a line is sorted by, and the line
Place = tuple[int, int]  # in the file: from where, how long [bytes]
KEY = itemgetter(0)
WHAT = "the lines of a long list"


def in_order(found: Iterable[Keyed], reverse: bool = False) -> Iterator[str]:
    """The lines of `found` in order of their keys, or the other way round; of equal ones the first comes first.

    Of n lines the memory holds PIECE, later n·BACK/PIECE. Raises DataError when the temporary file has no room.
    """
    rest = iter(found)
    piece = _sorted(rest, reverse)
    if len(piece) < PIECE:
        yield from (line for _, line in piece)
        return
    with _file() as file:
        kept = []
        while piece:
            kept.append(_put_away(piece, file))
            piece = _sorted(rest, reverse)
        pieces = (_taken_back(places, file.fileno()) for places in kept)
        yield from (line for _, line in heapq.merge(*pieces, key=KEY, reverse=reverse))


def _sorted(rest: Iterator[Keyed], reverse: bool) -> list[Keyed]:
    """The next PIECE lines, or what is left of them."""
    return sorted(islice(rest, PIECE), key=KEY, reverse=reverse)


def _file() -> IO[bytes]:
    with room_for(WHAT):
        return tempfile.TemporaryFile()


def _put_away(piece: list[Keyed], file: IO[bytes]) -> list[Place]:
    places = []
    with room_for(WHAT):
        for first in range(0, len(piece), BACK):
            data = pickle.dumps(piece[first : first + BACK])
            places.append((file.tell(), len(data)))
            file.write(data)
        file.flush()
    return places


def _taken_back(places: list[Place], handle: int) -> Iterator[Keyed]:
    for start, length in places:
        yield from pickle.loads(os.pread(handle, length, start))
