"""Close a run, in steps that can be interrupted between any two and done again. The status comes last, so a run that
was not closed to the end says so."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import pyarrow as pa
import pyarrow.parquet as pq

from rig.core.errors import DataError, UsageError
from rig.core.regular import regular
from rig.core.ring import Ring
from rig.runfile import archive, manifest
from rig.runfile.columns import columns_of_rows, schema_of
from rig.runfile.journal import JournalReader, JournalWriter, rows_in_journal
from rig.runfile.process import sole_writer, this_process
from rig.runfile.remains import journal_files, ring_of

READ_ONLY = 0o444
PATIENCE = 5.0  # s for a killed recorder to be gone altogether

StepHook = Callable[[str], None]
"""Called with the name of each step before it is done."""


class Closed(NamedTuple):
    """What a closed run holds, and how it came together."""

    rows: int
    seconds: float
    from_ring: int  # rows that were still in shared memory
    torn_bytes: int  # of the journal, half written when it was killed
    missing: int  # rows that should lie between two batches and do not
    lost: int = 0  # rows the loop made that are nowhere


def finalise(
    folder: Path,
    status: str,
    reason: str,
    *,
    timing: Mapping[str, Any] | None = None,
    expected_rows: int | None = None,
    step: StepHook = lambda name: None,
    **facts: Any,
) -> Closed:
    """Make a run that has ended readable, checked and read-only.

    `status` is completed, stopped, tripped or interrupted, `reason` a sentence; `timing` goes to timing.json, `facts`
    are further keys of the manifest. `expected_rows` is how many the loop put: where fewer are found the run ends as
    interrupted, whatever `status` says, and the reason gives both numbers.

    Raises UsageError when the run is closed already, DataError when a file cannot be
    written; it can then be called again, or `recover` later.
    """
    about = manifest.as_written(folder)
    if is_closed(about):
        raise UsageError(f"{folder} is closed already, as {about['status']}: {about.get('exit_reason', '')}")
    if status not in manifest.ENDINGS:
        raise UsageError(f"a run cannot end as {status!r}, expected one of {', '.join(manifest.ENDINGS)}")
    if not ring_of(about).exists():
        _refuse_fewer_rows(folder)
    if expected_rows is not None:
        facts["rows_expected"] = expected_rows
    with manifest.told(DataError, f"{folder} cannot be closed"), sole_writer(folder, PATIENCE):
        return _close(folder, status, reason, timing, facts, step)


def is_closed(about: Mapping[str, Any]) -> bool:
    """True when every step was done."""
    return about.get("status") != "running" and archive.NAME in (about.get("files") or {}) and "closing" not in about


def _close(
    folder: Path,
    status: str,
    reason: str,
    timing: Mapping[str, Any] | None,
    facts: Mapping[str, Any],
    step: StepHook,
) -> Closed:
    step("claim")
    ended = manifest.utc_now()
    _remove_parts(folder)
    closing = {"status": status, "reason": reason}
    told = {key: facts[key] for key in ("rows_expected",) if key in facts}  # needed by whoever closes it if we die
    about = manifest.update(folder, **told, process=this_process(), closing=closing)
    step("drain")
    from_ring = drain(folder, about)
    step("archive")
    _refuse_fewer_rows(folder)
    reader = JournalReader(folder)
    held = archive.write_archive(folder, archive.row_groups(reader), schema_of(about))
    lost = lost_rows(about, held.rows)
    if lost:
        status = "interrupted"
        expected = about["rows_expected"]
        reason = f"{reason}; but of the {expected} rows the loop made {held.rows} are here and {lost} are lost"
    step("timing")
    if timing is not None:
        manifest.write_atomic(folder / "timing.json", json.dumps(timing, indent=1).encode() + b"\n")
    step("hash")
    files = {p.name: describe(p) for p in raw_files(folder)}
    files[archive.NAME]["rows"] = held.rows
    manifest.update(folder, **facts, files=about.get("files", {}) | files, rows=held.rows, duration=held.seconds)
    step("protect")
    for path in raw_files(folder):
        path.chmod(READ_ONLY)
    step("status")
    done = {"ring": None, "process": None, "closing": None}
    manifest.update(folder, status=status, exit_reason=reason, ended_utc=about.get("ended_utc", ended), **done)
    return Closed(held.rows, held.seconds, from_ring, reader.torn_bytes, reader.missing, lost)


def lost_rows(about: Mapping[str, Any], rows: int) -> int:
    """Of the rows the loop said it put, how many are not among those found; 0 where it said nothing."""
    expected = about.get("rows_expected")
    return max(0, expected - rows) if isinstance(expected, int) else 0


def _refuse_fewer_rows(folder: Path) -> None:
    """Raises DataError when the journal cannot stand in for the archive that is there: it would be lost."""
    path = folder / archive.NAME
    if not path.exists():
        return
    try:
        regular(path)
        held = pq.read_metadata(path).num_rows
    except (OSError, pa.ArrowException) as error:
        raise DataError(f"{path} cannot be read, and is not overwritten; move it away and try again") from error
    rows = sum(batch.num_rows for batch in JournalReader(folder))
    if rows < held or not journal_files(folder):
        raise DataError(f"{path} holds {held} rows, the journal {rows}: it is not overwritten")


def drain(folder: Path, about: Mapping[str, Any]) -> int:
    """Rows a dead recorder left in shared memory, appended to a new journal; returns how many. Raises OSError.

    The ring goes only when they are on disk, so this can be done again.
    """
    path = ring_of(about)
    if not path.exists():
        return 0
    ring = Ring.attach(path)
    refuse_stranger(ring, folder)
    have = rows_in_journal(folder)
    left = ring.head - max(have, ring.oldest)
    if left > 0:
        journal = JournalWriter(folder, schema_of(about), first=max(have, ring.oldest))
        try:
            journal.append(columns_of_rows(ring.read(journal.rows, ring.head)))
        finally:
            journal.close()
    ring.unlink()
    ring.close()
    return max(left, 0)


def refuse_stranger(ring: Ring, folder: Path) -> None:
    """Raises UsageError when the rows in `ring` are those of another folder."""
    if not ring.belongs_to(folder):
        raise UsageError(
            f"the rows in {ring.path} belong to {ring.owner or 'another folder'}, of which {folder} is a copy: "
            "close or recover that one first"
        )


def raw_files(folder: Path) -> list[Path]:
    """What was measured and how: never written again once the run is closed."""
    named = [folder / name for name in ("bench.toml", "events.jsonl", archive.NAME, "timing.json")]
    return [p for p in (*named, *journal_files(folder)) if p.exists()]


def describe(path: Path) -> dict[str, Any]:
    """An entry of the manifest's `files`: SHA-256 and size [bytes]. Raises OSError."""
    size = regular(path).st_size
    with open(path, "rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    return {"sha256": digest, "bytes": size}


def add_derived(folder: Path, *names: str, **facts: Any) -> None:
    """Enter files made from the samples (result.json, report.html) into the manifest, as often as they are made anew.

    `facts` are keys of the manifest that go with them (`verdict="pass"`). Raises UsageError for a raw file, DataError.
    """
    about = manifest.as_written(folder)
    for name in names:
        if folder / name in raw_files(folder):
            raise UsageError(f"{name} of {folder} is raw data: it is entered once, when the run is closed")
    with manifest.told(DataError, f"the manifest of {folder} cannot be written"):
        entries = {name: {**describe(folder / name), "derived": True} for name in names}
        manifest.update(folder, files=about.get("files", {}) | entries, **facts)


def _remove_parts(folder: Path) -> None:
    """What a kill left half written under a name of its own."""
    for part in folder.glob(".*.part"):
        part.unlink()
