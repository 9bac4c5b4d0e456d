"""A closed run whose samples.parquet is gone is made whole from its journal, which is kept beside it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rig.core.errors import DataError
from rig.runfile import archive, manifest
from rig.runfile.columns import schema_of
from rig.runfile.finalise import READ_ONLY, describe
from rig.runfile.journal import JournalReader
from rig.runfile.process import sole_writer
from rig.runfile.remains import journal_files


def samples_as_closed(folder: Path, about: Mapping[str, Any]) -> bool:
    """True when samples.parquet is the file the run was closed with, False when it is gone.

    Raises DataError when another file stands in its place: that is not overwritten.
    """
    path = folder / archive.NAME
    if not path.exists():
        return False
    said = about["files"][archive.NAME].get("sha256")  # a folder of somebody else may not say
    with manifest.told(DataError, f"{path} cannot be read"):
        same = said is None or describe(path)["sha256"] == said
    if not same:
        anew = "move it away, and hdrig recover makes it anew from the journal"
        nothing = "there is no journal to make it anew from: the file it was has to come from a copy of the folder"
        raise DataError(
            f"{path} is not the file the run was closed with, and is not overwritten; "
            f"{anew if journal_files(folder) else nothing}"
        )
    return True


def restore(folder: Path, about: Mapping[str, Any]) -> int:
    """Make samples.parquet anew from the journal; the status stays what it was. Returns its rows.

    Raises DataError when there is no journal, when it is not the one the run was closed with, or when nothing can be
    written.
    """
    journals = journal_files(folder)
    if not journals:
        raise DataError(f"{archive.NAME} of {folder} is gone, and there is no journal to make it from")
    with manifest.told(DataError, f"{folder} cannot be recovered"), sole_writer(folder, 0.0):
        changed = [p.name for p in journals if describe(p)["sha256"] != about["files"].get(p.name, {}).get("sha256")]
        if changed:
            raise DataError(
                f"{archive.NAME} of {folder} is gone, and {changed[0]} is not what it was: see hdrig verify"
            )
        held = archive.write_archive(folder, archive.row_groups(JournalReader(folder)), schema_of(about))
        path = folder / archive.NAME
        entry = {**describe(path), "rows": held.rows}
        path.chmod(READ_ONLY)
        manifest.update(folder, files={**about["files"], archive.NAME: entry}, restored_utc=manifest.utc_now())
    return held.rows
