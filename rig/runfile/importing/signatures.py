"""Is a file what its suffix says? Judged by its first bytes, before a library sees them."""

from __future__ import annotations

from pathlib import Path

from rig.core.errors import UsageError
from rig.core.regular import regular

HDF5 = b"\x89HDF\r\n\x1a\n"
# first bytes, what it is, the suffix it should have
SIGNATURES: tuple[tuple[bytes, str, str], ...] = (
    (b"PAR1", "Parquet", ".parquet"),
    (b"MDF     ", "MDF", ".mf4"),
    (b"UnFinMF ", "MDF not closed by its logger", ".mf4"),
    (b"TDSm", "TDMS", ".tdms"),
    (b"MATLAB 5.0 MAT-file", "MAT", ".mat"),
    (b"MATLAB 7.3 MAT-file", "MAT", ".mat"),
    (HDF5, "HDF5", ".h5"),
    (b"ARROW1", "Arrow", ".arrow"),
    (b"PK\x03\x04", "a zip archive or an Excel sheet", ".zip"),
    (b"\x1f\x8b", "a gzip archive", ".gz"),
    (b"TDSh", "a TDMS index", ".tdms_index"),
)


def identify(head: bytes) -> tuple[str, str]:
    """(what it is, the suffix it should have), ("", "") for no known signature."""
    return next(((kind, suffix) for mark, kind, suffix in SIGNATURES if head.startswith(mark)), ("", ""))


def check_kind(path: Path, kind: str) -> None:
    """Raises UsageError when `path` is absent, empty, or not of `kind` ("CSV" is text, so anything unmarked)."""
    try:
        size = regular(path).st_size
        with path.open("rb") as file:
            head = file.read(4096)
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror}") from None
    if size == 0:
        raise UsageError(f"{path.name} is empty (0 bytes); expected a {kind} file")
    found, suffix = identify(head)
    if found == kind or (kind == "CSV" and not found):
        return
    looks = f"it is {found}: expected the suffix {suffix}" if found else f"it begins with {head[:8]!r}"
    raise UsageError(f"{path.name} ({size} bytes) is not a {kind} file, as its suffix says: {looks}")
