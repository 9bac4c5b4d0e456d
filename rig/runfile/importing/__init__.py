"""`hdrig import`: a file of another logger and a small mapping file → a run folder, strictly.

| module | one idea |
|---|---|
| mapping, keys, channel, strict, units | the mapping file, read so that no key is overlooked |
| readers/ | one format a file: the wanted columns, 1-D |
| table, signatures, reading | what readers share: finding a column, telling a file by its first bytes, damage |
| convert, unwrap, timing | columns → SI channels |
| refuse, plausible | what cannot be meant, one sentence each |
| write | channels → run folder, through rig.runfile |
| earlier | whether the same file was imported before |

To add a format: one file in readers/, one line in READERS, one in signatures.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rig.core.errors import UsageError

if TYPE_CHECKING:
    from rig.runfile.importing.table import Reader

# suffix → what such a file is, and its reader, loaded only when used
READERS: dict[str, tuple[str, str]] = {
    ".csv": ("CSV", "rig.runfile.importing.readers.csv:read"),
    ".txt": ("CSV", "rig.runfile.importing.readers.csv:read"),
    ".tsv": ("CSV", "rig.runfile.importing.readers.csv:read"),
    ".parquet": ("Parquet", "rig.runfile.importing.readers.parquet:read"),
    ".mat": ("MAT", "rig.runfile.importing.readers.mat:read"),
    ".h5": ("HDF5", "rig.runfile.importing.readers.hdf5:read"),
    ".hdf5": ("HDF5", "rig.runfile.importing.readers.hdf5:read"),
    ".mf4": ("MDF", "rig.runfile.importing.readers.mdf:read"),
    ".tdms": ("TDMS", "rig.runfile.importing.readers.tdms:read"),
}


def import_file(
    source: Path, mapping: Path | str, out: Path, software: Mapping[str, Any] | None = None, again: bool = False
) -> Path:
    """Make a run folder of `source` under the root `out`, and return it.

    `mapping` is a file, or the name of a mapping that comes with the program. `software` is what the manifest says made
    the run; `again` makes one also of a file that was imported there before. Raises UsageError, one sentence, for
    anything that cannot be meant: then nothing was written. Raises NotReady when `out` cannot be written to.
    """
    import numpy as np

    from rig.runfile.importing import convert, earlier, plausible, reading, write
    from rig.runfile.importing import mapping as mappings

    kind, read = reader(source)
    wanted = mappings.load_mapping(mapping)
    table = reading.read_table(source, kind, read, wanted)
    if not again:
        earlier.refuse_again(source, wanted, out)
    wanted = convert.with_file_units(wanted, table.units, source.name)
    with np.errstate(over="ignore", invalid="ignore"):  # absurd numbers are refused by what they amount to
        run = convert.convert(table, wanted, source.name)
        plausible.check(run, wanted, source.name)
    return write.write_run(run, wanted, source, out, software)


def reader(source: Path) -> tuple[str, Reader]:
    """(what the suffix says the file is, how to read it). Raises UsageError for a suffix not in the catalogue."""
    if source.is_dir():
        raise UsageError(f"{source} is a folder; expected a file ending in one of {', '.join(READERS)}")
    if source.suffix.lower() not in READERS:
        raise UsageError(
            f"{source.name}: suffix '{source.suffix}' cannot be imported; expected one of {', '.join(READERS)}"
        )
    kind, where = READERS[source.suffix.lower()]
    module, _, function = where.partition(":")
    return kind, getattr(importlib.import_module(module), function)
