"""Does a run keep its promises? Manifest, hashes, rows, time order, gaps, flags, values, journal and archive."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from rig.core.channels import Flag
from rig.core.drivetrain import RATIOS
from rig.core.errors import DataError, Exit, HdrigError, UsageError, said_of
from rig.core.numbers import number
from rig.runfile import archive, manifest
from rig.runfile.columns import Array
from rig.runfile.finalise import describe, is_closed, lost_rows, raw_files
from rig.runfile.finding import Finding
from rig.runfile.journal import JournalReader
from rig.runfile.misfits import misfits, misfits_of_ours, mistyped
from rig.runfile.origin import SIM
from rig.runfile.process import is_being_made
from rig.runfile.promised import time_untold
from rig.runfile.remains import advice, journal_files
from rig.runfile.run import Run
from rig.runfile.samples import Archive
from rig.runfile.values import values

GAP = 1.5  # periods between two rows that are still neighbours
LOST = 1.9  # periods from which a row may really be gone: a late tick alone stays below two
REFUSED = 1  # ticks without a row: the one in which a procedure refused to go on
MAKE_UP = 5  # rows within which a late tick has been made up for: the loop counts deadlines, not delays


def verify(folder: Path) -> list[Finding]:
    """Everything worth saying about a run; no "error" among it means the promises are kept. Raises UsageError when it
    is no run folder at all, or a file of it may not be read.
    """
    try:
        about = manifest.as_written(folder)
    except manifest.Damaged as damage:
        return [Finding("error", "manifest", said_of(folder, damage))]
    findings = [*_status(folder, about), *_hashes(folder, about), *_read_only(folder, about)]
    findings += [Finding("error", "manifest", f"{manifest.NAME}: {said}") for said in misfits(about)]
    odd = (*misfits_of_ours(about), *mistyped(about))
    findings += [Finding("warning", "manifest", f"{manifest.NAME}: {said}") for said in odd]
    findings += _ratio(about)
    try:
        run = Run.open(folder)
    except HdrigError as error:
        if isinstance(error, DataError) and error.exit is Exit.USAGE:  # nobody may read them: as of a hash
            raise
        return [*findings, Finding("error", "samples", str(error))]
    for check in (_rows, _time, _gaps, _flags, values, _journal):
        findings += check(run)
    return [*findings, *_backend(run, about)]


def _is_foreign(about: Mapping[str, Any]) -> bool:
    """Not of our recorder: read in from a file, be it of the twin's samples."""
    return about.get("backend") == "imported" or "import" in about


def _status(folder: Path, about: Mapping[str, Any]) -> Iterator[Finding]:
    if is_closed(about) or _is_foreign(about) or "status" not in about:
        return
    if is_being_made(about):
        yield Finding("warning", "status", f"process {about['process']['pid']} is still making this run")
    else:
        yield Finding("error", "status", f"the run was never closed; {advice(folder, about)}")


def _ratio(about: Mapping[str, Any]) -> Iterator[Finding]:
    """A number that no gear has; one that is none is refused where the run is opened."""
    ratio = number((about.get("gear") or {}).get("ratio"))
    if ratio > 0.0 and not RATIOS[0] <= ratio <= RATIOS[1]:
        expected = f"expected {RATIOS[0]:g} to {RATIOS[1]:g}"
        yield Finding("error", "manifest", f"{manifest.NAME}: gear.ratio is {ratio:g}, {expected}")


def _hashes(folder: Path, about: Mapping[str, Any]) -> Iterator[Finding]:
    files = about.get("files", {})
    if not files:
        yield Finding("note", "hashes", "the manifest holds no hashes: whether a file was changed cannot be told")
    for name, said in files.items():
        try:
            same = describe(folder / name)["sha256"] == said.get("sha256")
        except FileNotFoundError:
            yield Finding("error", "hashes", f"{name} is in the manifest and not in the folder")
        except PermissionError as error:  # whether a promise is broken there is not known
            raise UsageError(f"{folder / name} cannot be read: {error.strerror}") from None
        except OSError as error:
            yield Finding("error", "hashes", f"{name} cannot be read: {error.strerror}")
        else:
            if not same:
                yield Finding("error", "hashes", f"{name} is not what it was: its SHA-256 differs from the manifest's")


def _read_only(folder: Path, about: Mapping[str, Any]) -> Iterator[Finding]:
    if not is_closed(about):
        return
    for path in raw_files(folder):
        if path.stat().st_mode & 0o222:
            yield Finding("warning", "read-only", f"{path.name} can be written to; raw files should be read-only")


def _rows(run: Run) -> Iterator[Finding]:
    said = run.manifest.get("files", {}).get(archive.NAME, {}).get("rows")
    if said is not None and said != run.rows:
        yield Finding("error", "rows", f"{run.rows} rows, the manifest says {said}")
    lost, made = lost_rows(run.manifest, run.rows), run.manifest.get("rows_expected")
    ticks = run.timing.get("ticks")
    if not lost and isinstance(ticks, int) and ticks - run.rows > REFUSED:
        lost, made = ticks - run.rows, ticks
    if lost:
        yield Finding("error", "rows", f"{lost} of {made} rows the loop made are missing")


def _time(run: Run) -> Iterator[Finding]:
    """Rows as far apart, and a run as long, as the manifest says."""
    if sentence := time_untold(run.manifest, run.column("t")):
        yield Finding("error", "time", sentence)


def _gaps(run: Run) -> Iterator[Finding]:
    """Steps of `t` longer than 1.5 periods, by why: told by the loop, a late tick made up for, a stale reading, or a
    lost row."""
    t = run.column("t")
    if t is None or t.size < 3:
        return
    with np.errstate(invalid="ignore"):  # a time that is infinite is no gap, nor is it one where there is none
        dt = np.diff(t)
    period = float(np.median(dt[dt > 0])) if (dt > 0).any() else np.inf  # equal times are stale rows
    gaps, flags = np.flatnonzero(dt > GAP * period), run.flags
    told = ((flags[gaps + 1] & int(Flag.MISSED)) | (flags[gaps] & int(Flag.STALE_M))) > 0
    late = ~told & np.array([_made_up_for(t, int(i), period) for i in gaps], dtype=bool)
    if _every_tick_has_its_row(run):
        late = ~told  # nothing is gone: the machine woke late, less than the one period that the loop flags
    late |= ~told & (dt[gaps] < LOST * period)
    stale = ~told & ~late & _read_late(run, gaps, dt, period)
    unexplained, why_not = "error", "unexplained"
    if _is_foreign(run.manifest):  # no loop of ours, no promise
        unexplained = "warning"
    elif run.manifest.get("status") == "interrupted" and "ticks" not in run.timing:
        unexplained, why_not = "warning", "a late tick or a lost row: the loop died before it could say how many"
    for level, found, why in (
        ("warning", gaps[told], "flagged by the loop: it skipped ticks there, or had no new motor angle"),
        ("warning", gaps[late], "a tick came late, no row is gone"),
        ("warning", gaps[stale], "a stale reading and then a fresh one (their `age`), no row is gone"),
        (unexplained, gaps[~told & ~late & ~stale], why_not),
    ):
        if found.size:
            worst = int(found[np.argmax(dt[found])])
            many = f"{found.size} gap{'s' if found.size > 1 else ''}"
            many += f" longer than {GAP} periods of {period * 1e3:.4g} ms, {why}"
            yield Finding(level, "gaps", f"{many}; the longest is {dt[worst] * 1e3:.4g} ms at t = {t[worst]:.3f} s")


def _every_tick_has_its_row(run: Run) -> bool:
    """The loop counted its ticks, and as many rows are here."""
    return bool(run.rows) and run.timing.get("ticks") == run.rows


def _read_late(run: Run, gaps: npt.NDArray[np.intp], dt: Array, period: float) -> npt.NDArray[np.bool_]:
    """Of the steps of `t` [s] behind the rows `gaps` those between neighbouring ticks: `t` is when an angle was
    latched, `t` and `age` together when its row was made; after a stall a fresh reading may follow an old one."""
    age = run.column("age")
    if age is None:
        return np.zeros(gaps.size, dtype=bool)
    return np.asarray(dt[gaps] + age[gaps + 1] - age[gaps] <= GAP * period)


def _made_up_for(t: Array, i: int, period: float) -> bool:
    """True when the rows after the gap behind row `i` stand again where they would without it."""
    after = t[i + 1 : i + 1 + MAKE_UP] - t[i]
    in_time = (np.arange(after.size) + 1.5) * period
    return bool((after < in_time).any() or (after.size < MAKE_UP and after[0] < 2 * period))


def _flags(run: Run) -> Iterator[Finding]:
    flags = run.flags
    for flag in Flag:
        count = int(np.count_nonzero(flags & int(flag)))
        if count and flag is not Flag.SIMULATED:
            yield Finding("note", "flags", f"{count} of {run.rows} rows are flagged {flag.name}")


def _backend(run: Run, about: Mapping[str, Any]) -> Iterator[Finding]:
    """Simulated and measured rows never mix, and the manifest says which they are: `about` as it is written, the run
    having the samples' word for it where they say that they are the twin's.
    """
    said = about.get("backend")
    if said is None:
        return
    if run.simulated and said != SIM:
        twins = f"{run.samples.path.name} says that its samples are simulated"
        expected = f"expected {SIM!r}; the run counts as simulated"
        yield Finding("warning", "backend", f"{twins}, and {manifest.NAME} that the backend is {said!r}, {expected}")
    if not run.has("flags") or not run.rows or _is_foreign(about):
        return
    simulated = int(np.count_nonzero(run.flags & int(Flag.SIMULATED)))
    if simulated != (run.rows if said == SIM else 0):
        yield Finding("error", "backend", f"{simulated} of {run.rows} rows are simulated, the backend is {said!r}")


def _journal(run: Run) -> Iterator[Finding]:
    """Row by row the same in the journal and in the archive made from it."""
    if not journal_files(run.path):
        return
    if not isinstance(run.samples, Archive):
        return
    reader = JournalReader(run.path)
    row = 0
    made = archive.row_groups(reader)
    for kept in run.samples.row_groups():
        table = next(made, None)
        if table is None or not table.equals(kept):
            yield Finding("error", "journal", f"journal and {archive.NAME} differ from row {row} on")
            return
        row += kept.num_rows
    if next(made, None) is not None:
        yield Finding("error", "journal", f"the journal has rows after row {row}, where {archive.NAME} ends")
    yield from _journal_state(reader)


def _journal_state(reader: JournalReader) -> Iterator[Finding]:
    if reader.torn_bytes:
        yield Finding("note", "journal", f"{reader.torn_bytes} bytes of a half written batch are left out")
    if reader.missing:
        yield Finding("error", "journal", f"{reader.missing} rows are missing between two batches of the journal")
