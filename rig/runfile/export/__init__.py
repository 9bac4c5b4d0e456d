"""A run for other programs: one format a file, each with units, and saying where the samples are simulated.

To add a format: one file with `write(run, path)`, one line in FORMATS.
"""

from __future__ import annotations

import contextlib
import importlib
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from rig.core.errors import UsageError
from rig.runfile.extra import how_to_install
from rig.runfile.run import Run


class Format(NamedTuple):
    """One way to write a run; `module` is loaded only when used."""

    suffix: str
    module: str
    readers: str  # who reads it


FORMATS: dict[str, Format] = {
    "csv": Format(".csv", "rig.runfile.export.csv", "spreadsheets, anything"),
    "mdf4": Format(".mf4", "rig.runfile.export.mdf4", "CANape, DIAdem, MDA, asammdf"),
    "mcap": Format(".mcap", "rig.runfile.export.mcap", "Foxglove, PlotJuggler"),
    "hdf5": Format(".h5", "rig.runfile.export.hdf5", "MATLAB, h5py, Igor"),
}


def export(run: Run, kind: str, target: Path | None = None) -> Path:
    """Write `run` as `kind` (a key of FORMATS) and return the file.

    `target` is a file or a folder; without it the file stands in the run folder. Raises UsageError
    when the format is unknown, its package is not installed, the file exists (nothing is overwritten) or cannot be
    written; then there is no file.
    """
    if kind not in FORMATS:
        raise UsageError(f"there is no format {kind!r}, expected one of {', '.join(FORMATS)}")
    form = FORMATS[kind]
    writer = _load(kind, form)
    path = _target(run, form, target)
    with _in_place(path) as part:
        writer(run, part)
    return path


def _load(kind: str, form: Format) -> Callable[[Run, Path], None]:
    try:
        write: Callable[[Run, Path], None] = importlib.import_module(form.module).write
    except ModuleNotFoundError as error:
        raise UsageError(
            f"{kind} needs the package {error.name}, which is not installed; {how_to_install()}"
        ) from error
    return write


def _target(run: Run, form: Format, target: Path | None) -> Path:
    name = f"{run.name}{form.suffix}"
    if target is None:
        return run.path / name
    if target.suffix == form.suffix and not target.is_dir():
        return target
    if target.suffix and not target.is_dir():
        raise UsageError(f"{target} ends in {target.suffix}, this format in {form.suffix}; give that, or a folder")
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"cannot write {target}: {error.strerror}; name another place with --out") from error
    return target / name


@contextlib.contextmanager
def _in_place(path: Path) -> Iterator[Path]:
    """A name to write under, beside `path`; on success it becomes `path`, otherwise nothing is left."""
    part = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        path.touch(exist_ok=False)  # ours from here: nobody else can have made it in between
    except FileExistsError:
        raise UsageError(f"{path} exists already; nothing is overwritten") from None
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror}; name another place with --out") from error
    try:
        yield part
        part.replace(path)
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror or error}; name another place with --out") from error
    finally:
        part.unlink(missing_ok=True)
        if not path.stat().st_size:
            path.unlink()
