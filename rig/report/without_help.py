"""matplotlib without its pages of help: it writes one for every kind of artist, half of the time of its import."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from matplotlib import artist


@contextmanager
def without_help() -> Iterator[None]:
    """Of what is imported meanwhile, the docstrings lack the table of properties; nothing is drawn otherwise."""
    usual = artist.kwdoc
    artist.kwdoc = lambda artist: ""
    try:
        yield
    finally:
        artist.kwdoc = usual
