"""Channels → a finished run folder, through rig.runfile. It is there whole, or not at all."""

from __future__ import annotations

import contextlib
import os
import shutil
from collections.abc import Mapping as Dict
from datetime import UTC
from pathlib import Path
from typing import Any

import pyarrow as pa

from rig import __version__
from rig.core.errors import UsageError
from rig.runfile import manifest as manifests
from rig.runfile.archive import NAME as SAMPLES
from rig.runfile.archive import open_parquet
from rig.runfile.finalise import READ_ONLY, describe
from rig.runfile.folder import create_hidden, shown
from rig.runfile.importing.convert import Converted
from rig.runfile.importing.mapping import Mapping
from rig.runfile.importing.sweep import sweep

MAPPING_COPY = "import.toml"


def write_run(run: Converted, mapping: Mapping, source: Path, root: Path, software: Dict[str, Any] | None) -> Path:
    """Make the folder under `root`; returns it. Raises UsageError when it cannot be written; then nothing is left. What
    a kill leaves is hidden, no run, and swept by the next import there."""
    with manifests.told(UsageError, f"{source} cannot be read any more"):
        about = manifest_of(run, mapping, source, software)
    sweep(root)
    folder = create_hidden(root, mapping.procedure, about)
    done = False
    try:
        with manifests.told(UsageError, f"cannot write the imported run to {folder}"):
            manifests.write_atomic(folder / MAPPING_COPY, mapping.text.encode())
            rows = _write_samples(folder, run)
            _close(folder, run, rows, source.name)
            whole = shown(folder)
        done = True
    finally:
        if not done:
            shutil.rmtree(folder, ignore_errors=True)
            with contextlib.suppress(OSError):  # the day's, which has other runs in it or was made for this one
                folder.parent.rmdir()
    return whole


def backend(run: Converted) -> str:
    """Simulated samples stay simulated, however many programs they went through."""
    return "sim" if run.simulated else "imported"


def manifest_of(run: Converted, mapping: Mapping, source: Path, software: Dict[str, Any] | None) -> dict[str, Any]:
    """What the manifest says of an imported run, without status and files."""
    about: dict[str, Any] = {
        "backend": backend(run),
        "gear": mapping.gear,
        "declared": mapping.declared,
        "conditions": mapping.conditions,
        "encoders": mapping.encoders,
        "software": dict(software or {"version": __version__}),
        "import": {
            "source": source.name,
            **describe(source),
            "mapping": mapping.source,
            "description": mapping.description,
            "imported_utc": manifests.utc_now(),
            "timing": run.time,
        },
        "notes": run.notes,
    }
    if run.utc is not None:
        stamp = run.utc.astimezone(UTC).isoformat(timespec="microseconds")
        about |= {"started_utc": stamp, "clock": {"utc_at_start": stamp}}
    return about


def table_of(run: Converted) -> pa.Table:
    """The samples as Arrow, `t` first; unit and meaning with every column, null where not measured."""
    fields, columns = [], []
    for name in sorted(run.channels, key=lambda n: n != "t"):
        values, unit, meaning = run.channels[name]
        fields.append(pa.field(name, pa.from_numpy_dtype(values.dtype), metadata={"unit": unit, "meaning": meaning}))
        columns.append(pa.array(values, from_pandas=True))  # from_pandas: NaN is null
    about = {"schema": manifests.SCHEMA, "backend": backend(run), "simulated": str(run.simulated).lower()}
    return pa.table(columns, schema=pa.schema(fields, metadata=about))


def _write_samples(folder: Path, run: Converted) -> int:
    table = table_of(run)
    with open(folder / SAMPLES, "wb") as file:
        with open_parquet(file, table.schema) as writer:
            writer.write_table(table)
        file.flush()
        os.fsync(file.fileno())
    return int(table.num_rows)


def _close(folder: Path, run: Converted, rows: int, source: str) -> None:
    """Hashes, read-only, completed. A start nobody knows is taken out: the folder's date is when it was imported."""
    paths = [folder / SAMPLES, folder / MAPPING_COPY]
    files = {path.name: describe(path) for path in paths}
    files[SAMPLES]["rows"] = rows
    for path in paths:
        path.chmod(READ_ONLY)
    unknown = {} if run.utc is not None else {"started_utc": None, "clock": None}
    held = {"files": files, "rows": rows, "duration": run.time.get("span")}
    manifests.update(folder, **held, **unknown, process=None, status="completed", exit_reason=f"imported from {source}")
