"""A foreign file through its library: what the library does over damaged bytes ends as one sentence, not on stderr."""

from __future__ import annotations

import contextlib
import gc
import logging
import struct
import sys
import warnings
import zlib
from collections.abc import Iterator
from pathlib import Path

from rig.core.errors import UsageError
from rig.runfile.extra import how_to_install
from rig.runfile.importing.mapping import Mapping
from rig.runfile.importing.signatures import check_kind
from rig.runfile.importing.table import Reader, Table

OPTIONAL = ("asammdf", "h5py", "nptdms")  # the extra `exchange`

# What the libraries of others raise over damaged bytes. Not Exception: a fault of ours shall show as one.
DAMAGED = (
    ArithmeticError, AssertionError, AttributeError, BufferError, EOFError, LookupError, MemoryError, OSError,
    RuntimeError, TypeError, ValueError, UnboundLocalError, struct.error, zlib.error,
)  # fmt: skip


def read_table(path: Path, kind: str, read: Reader, mapping: Mapping) -> Table:
    """The mapped columns of `path`, which should be of `kind`. Raises UsageError, one sentence."""
    check_kind(path, kind)
    with _quiet():
        try:
            return read(path, mapping.columns, mapping.csv)
        except ImportError as error:
            package = str(error.name).partition(".")[0]
            if package not in OPTIONAL:
                raise
            complaint = UsageError(
                f"reading {kind} needs the package {package}, which is not installed; {how_to_install()}"
            )
        except DAMAGED as error:
            complaint = damaged(path, kind, error)
        gc.collect()  # the library's half-made objects go now, while it is quiet: their destructors fail too
    raise complaint


def damaged(path: Path, kind: str, error: BaseException) -> UsageError:
    """The sentence for a file its library could not read to the end."""
    reason = " ".join(str(error).split())[:200] or type(error).__name__
    size = path.stat().st_size
    return UsageError(f"{path.name} ({size} bytes) is damaged or cut short and cannot be read as {kind}: {reason}")


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """No warnings and log lines of libraries, and none of their destructors' complaints over half-made objects."""
    hook, level = sys.unraisablehook, logging.root.manager.disable
    sys.unraisablehook = lambda _: None
    logging.disable(logging.CRITICAL)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        logging.disable(level)
        sys.unraisablehook = hook
