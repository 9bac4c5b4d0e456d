"""Whose samples a run holds: the twin's, as soon as the manifest or the samples say so. Decided here and nowhere else.

A manifest may be written by anybody and say nothing of it, or something else; samples of ours say it themselves, in the
metadata of their file. Measured samples never say that they are simulated, so one sign is enough.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rig.core.regular import regular
from rig.runfile.remains import SAMPLES, journal_files

SIM = "sim"  # `backend` of the twin's runs, over whatever wire they came


def with_origin(folder: Path, about: Mapping[str, Any]) -> dict[str, Any]:
    """The manifest `about` of the run in `folder`, its `backend` "sim" where only the samples say that they are the
    twin's. A manifest that says it itself is believed, its samples are not looked at.
    """
    if about.get("backend") != SIM and samples_are_simulated(folder):
        return {**about, "backend": SIM}
    return dict(about)


def samples_are_simulated(folder: Path) -> bool:
    """Whether the samples in `folder` say so; False also where there are none, or none that can be read."""
    import pyarrow as pa  # here: who reads manifests of the twin's runs alone never needs it

    try:
        return says_simulated(_metadata(folder))
    except (OSError, ValueError, pa.ArrowException):
        return False


def says_simulated(metadata: Mapping[bytes, bytes] | None) -> bool:
    """Whether the metadata of a table of samples say that they are the twin's."""
    found = metadata or {}
    return found.get(b"simulated") == b"true" or found.get(b"backend") == SIM.encode()


def _metadata(folder: Path) -> Mapping[bytes, bytes] | None:
    """Of samples.parquet, else of the first journal; no row is read. Raises OSError, ArrowException."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    path = folder / SAMPLES
    if path.exists():
        regular(path)
        return pq.read_schema(path).metadata  # type: ignore[no-any-return]
    for journal in journal_files(folder)[:1]:
        regular(journal)
        with pa.OSFile(str(journal)) as source, pa.ipc.open_stream(source) as stream:
            return stream.schema.metadata  # type: ignore[no-any-return]
    return None
