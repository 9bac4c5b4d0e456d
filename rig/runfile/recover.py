"""What a killed program left → a readable run. Never "completed": a run found dead is interrupted."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from rig.core.errors import DataError, Exit, NotReady, UsageError
from rig.core.ring import Ring
from rig.runfile import archive, manifest
from rig.runfile.events import EventLog, mend_events, read_events
from rig.runfile.finalise import Closed, StepHook, finalise, is_closed, refuse_stranger
from rig.runfile.manifest import ratio_of
from rig.runfile.process import Process, lives
from rig.runfile.rebuild import rebuild
from rig.runfile.remains import ring_of, to_recover_from
from rig.runfile.restore import restore, samples_as_closed
from rig.runfile.samples import open_samples

ENDS, READY = ("state", "operator"), "ready: "  # how the event of a run that came to its end begins
FAULT = "fault: "  # how the event of a trip begins: the state it leads to


class Recovery(NamedTuple):
    """What was found and made of it."""

    rows: int
    seconds: float
    changed: bool  # False: the run was closed already and was left alone
    sentence: str


def recover(folder: Path, step: StepHook = lambda name: None) -> Recovery:
    """Close the run in `folder` with all that is there: whole batches of the journal, then rows still in shared memory.

    Can be interrupted and called again. Raises NotReady while the program that makes the run, or its recorder, lives;
    UsageError when it is no run folder; DataError when it cannot be written, or when the samples of a closed run are
    gone or changed and the journal cannot stand in for them. A manifest that is not JSON is rebuilt first.
    """
    about, rebuilt = _manifest(folder)
    rows, seconds = about.get("rows", 0), about.get("duration", 0.0)
    if is_closed(about):
        if not samples_as_closed(folder, about):
            made = restore(folder, about)
            told = f"{folder.name}: {archive.NAME} was gone and is made anew from the journal, {made} rows"
            return Recovery(made, seconds, True, told)
        done = f"{folder.name} is closed already, as {about.get('status')}, with {rows} rows: nothing to recover"
        return Recovery(rows, seconds, False, done)
    if _is_whole(folder, about):
        _refuse_unreadable(folder)
        done = f"{folder.name} has its {archive.NAME}, and neither a journal nor a ring: nothing to recover"
        return Recovery(rows, seconds, bool(rebuilt), f"{done}{rebuilt}")
    ratio_of(folder, about)
    _refuse_empty(folder, about)
    _refuse_living(folder, about)
    reason = _reason(folder, about)
    with manifest.told(DataError, f"{folder} cannot be recovered"):
        mend_events(folder)
        if "events.jsonl" not in about.get("files", {}):  # entered already: its hash is taken
            with EventLog(folder) as events:
                events.write("recover", reason)
    closed = finalise(folder, "interrupted", reason, step=step)
    return Recovery(closed.rows, closed.seconds, True, f"{_told(folder, closed)}{rebuilt}")


def _manifest(folder: Path) -> tuple[manifest.Manifest, str]:
    """The manifest, and what is to be said where it had to be rebuilt."""
    try:
        return manifest.as_written(folder), ""
    except manifest.Damaged as damage:
        about = rebuild(folder, damage)
        return about, f"; {about['exit_reason']}"


def _is_whole(folder: Path, about: Mapping[str, Any]) -> bool:
    """Samples and nothing they could be made of again: a folder of somebody else, or imported."""
    return (folder / archive.NAME).exists() and not to_recover_from(folder, about)


def _refuse_unreadable(folder: Path) -> None:
    """Raises DataError where the samples cannot be read, to the last of them."""
    try:
        for _ in open_samples(folder).batches():
            pass
    except DataError as error:
        if error.exit is Exit.USAGE:  # nobody may read them, and that says nothing of damage
            raise
        raise DataError(f"{error}; there is no journal and no ring to make it anew from") from error


def _refuse_empty(folder: Path, about: Mapping[str, Any]) -> None:
    """Raises UsageError when nothing is there to be recovered. A run of ours killed before its first row is closed."""
    ours = about.get("status") == "running" and "uid" in about and "process" in about
    if not ours and not to_recover_from(folder, about):
        raise UsageError(f"{folder} has no samples: neither {archive.NAME} nor a journal; nothing to recover")


def _refuse_living(folder: Path, about: Mapping[str, Any]) -> None:
    loop = about.get("process")
    if loop and loop.get("pid") != os.getpid() and lives(loop):  # our own try to close it may have failed
        raise NotReady(f"{folder.name} is still being made by process {loop['pid']}; stop that first")
    ring = ring_of(about)
    if ring.exists():
        recorder = _recorder_of(folder, ring, loop)
        if lives(recorder):
            raise NotReady(
                f"the recorder of {folder.name}, process {recorder['pid']}, is still writing; try again soon"
            )


def _recorder_of(folder: Path, path: Path, loop: Process | None) -> Process:
    ring = Ring.attach(path)
    try:
        refuse_stranger(ring, folder)
        pid, started = ring.reader
    finally:
        ring.close()
    return Process(pid=pid, started=started, host=str(loop.get("host", "")) if loop else "")


def _reason(folder: Path, about: Mapping[str, Any]) -> str:
    """What is known of the end."""
    closing, said = about.get("closing"), about.get("exit_reason")
    if about.get("status") != "running" and said:
        return str(said)  # the recorder outlived the loop and said so
    if closing and closing.get("status") != "interrupted":
        was = f"{closing.get('status')}: {closing.get('reason')}"
        return f"killed while its files were being closed; the run itself was {was}"
    if closing:
        return str(closing.get("reason"))
    found = f"found dead and recovered {manifest.utc_now()}"
    trips = [str(e.get("text")) for e in read_events(folder) if e.get("kind") == "trip" and e.get("t") is not None]
    if trips:  # those without a time were before this run
        return f"it had tripped, and its files were not closed after that: {trips[0].removeprefix(FAULT)}; {found}"
    ended = [str(e.get("text")) for e in read_events(folder) if e.get("kind") in ENDS and e.get("t") is not None]
    if ended and ended[-1].startswith(READY):
        return f"it was over, and its files were not closed after that: {ended[-1].removeprefix(READY)}; {found}"
    return f"the program was killed or the power failed; {found}"


def _told(folder: Path, closed: Closed) -> str:
    parts = [f"{folder.name}: {closed.rows} rows, {closed.seconds:.3f} s recovered"]
    if closed.from_ring:
        parts.append(f"{closed.from_ring} of them from shared memory")
    if closed.torn_bytes:
        parts.append(f"the last {closed.torn_bytes} bytes of the journal were half a batch and are left out")
    if closed.missing:
        parts.append(f"{closed.missing} rows are missing in between")
    if closed.lost:
        parts.append(f"{closed.lost} of the {closed.rows + closed.lost} rows the loop made are lost")
    return "; ".join(parts)
