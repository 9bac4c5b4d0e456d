"""What the analysis needs of a run, and the rows of it that can be trusted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.analysis.motion.angle import is_wrapped, joined, unwrap
from rig.analysis.motion.gaps import find_gaps, that_matter
from rig.analysis.motion.repeated import FAR, Repeated, repeated
from rig.core.channels import UNTRUSTED, Flag
from rig.core.rows import picked, room, stretches
from rig.core.units import ARCSEC, RPM, TURN
from rig.model.transmission_error import transmission_error

Rows = npt.NDArray[np.int64]
FASTEST = 1e-7  # s between rows: no encoder is read faster, so the column is not in s
SLOWEST = 60.0  # s between rows: nothing that turns is recorded more slowly
LOOKED_AT = 10_000  # rows, those first: a unit is the same all along, and a run may have a day of rows


class Source(Protocol):
    """A run as `rig.runfile` gives it. A column is float64 with NaN where nothing was measured, None when absent."""

    def column(self, name: str) -> Array | None: ...

    def has(self, name: str) -> bool: ...

    @property
    def manifest(self) -> Mapping[str, Any]: ...

    @property
    def misfits(self) -> Sequence[str]:
        """Of what the manifest says and cannot mean, a clause each; `manifest` is without it."""
        ...

    @property
    def name(self) -> str: ...

    @property
    def ratio(self) -> float: ...

    @property
    def procedure(self) -> str: ...

    @property
    def conditions(self) -> Mapping[str, Any]: ...

    @property
    def declared(self) -> Mapping[str, Any]: ...


@dataclass(frozen=True)
class Motion:
    """The rows in which the motor angle (and, if measured, the load angle) is valid; all shapes (n,), SI.

    `breaks` are the rows before which an encoder was re-referenced or rows are missing: angles do not join across them.
    """

    ratio: float
    theta_m: Array
    theta_l: Array | None
    t: Array | None
    rows: Rows | None  # which rows of the run these are; None: all
    breaks: tuple[int, ...] = ()
    notes: tuple[str, ...] = ()

    def error_arcsec(self, lo: int, hi: int) -> Array:
        """θ̃ of rows lo..hi, arcsec at the output      [ghorbel2001, Eq. 1]"""
        assert self.theta_l is not None
        return transmission_error(self.theta_m[lo:hi], self.theta_l[lo:hi], self.ratio) / ARCSEC

    def pick(self, column: Array | None) -> Array | None:
        """The same rows of another column of the run."""
        return column if column is None or self.rows is None else picked(column, self.rows)

    def speed_rpm(self, lo: int, hi: int) -> float:
        """Mean motor speed between two rows, rpm, signed; NaN without time."""
        if self.t is None or hi <= lo or self.t[hi] == self.t[lo]:
            return float("nan")
        return float((self.theta_m[hi] - self.theta_m[lo]) / (self.t[hi] - self.t[lo])) / RPM


def _angle(run: Source, side: str, notes: list[str]) -> Array | None:
    """theta_m or theta_l [rad]; from the raw counts when only they were recorded."""
    theta = run.column(f"theta_{side}")
    if theta is None:
        counts = run.column(f"counts_{side}")
        per_turn = run.manifest.get("encoders", {}).get({"m": "motor", "l": "load"}[side] + "_counts_per_rev")
        if counts is None or not per_turn:
            return None
        notes.append(f"theta_{side} was made from counts_{side} at {per_turn:g} counts per turn.")
        theta = counts * (TURN / float(per_turn))
    return theta


def _left_out(columns: Mapping[str, Array | None], gone: int) -> str:
    """How many rows are not used, `gone` in all, which of the channels as they were read has no usable value in most
    of them, and what else there may be."""
    holes = {name: ~np.isfinite(c) for name, c in columns.items() if c is not None}
    name = max(holes, key=lambda n: np.count_nonzero(holes[n]))
    missing, size = holes[name], holes[name].size
    count, first, last = np.count_nonzero(missing), int(missing.argmax()), size - 1 - int(missing[::-1].argmax())
    where = f"row {first}" if first == last else f"{count} of them (row {first} to {last})"
    reasons = [f"{name} has no usable value in {where}"] if count else []
    if count < gone:
        reasons.append("an angle was missing, stale or frozen, or the guard had tripped")
    return f"{gone} of {size} rows left out: {'; else '.join(reasons)}."


def _told(read: Mapping[str, Array | None], theta_m: Array, theta_l: Array | None) -> int:
    """Rows whose angles were read and are taken for missing since, which a note of their own says."""
    known = np.all([np.isfinite(c) for c in read.values() if c is not None], axis=0)
    missing = np.isnan(theta_m) if theta_l is None else np.isnan(theta_m) | np.isnan(theta_l)
    return int(np.count_nonzero(known & missing))


def motion_of(run: Source) -> Motion | None:
    """The trusted rows of `run`; None when it has no motor angle at all."""
    notes: list[str] = []
    theta_m, theta_l = _angle(run, "m", notes), _angle(run, "l", notes)
    if theta_m is None:
        return None
    t, flags = run.column("t"), run.column("flags")
    read = {"theta_m": theta_m, "theta_l": theta_l, "t": t}
    theta_m = _once(theta_m, theta_l, t, notes)
    theta_m, theta_l = _taken_anew(theta_m, theta_l, float(run.ratio), t, notes)
    rows, breaks = _trusted([c for c in (theta_m, theta_l, t) if c is not None], flags)
    if rows is not None:
        gone = theta_m.size - rows.size - _told(read, theta_m, theta_l)
        notes += [_left_out(read, gone)] if gone else []
        theta_m, theta_l = picked(theta_m, rows), None if theta_l is None else picked(theta_l, rows)
        t = None if t is None else picked(t, rows)
    t = _usable(t, notes)
    gaps = find_gaps(t if t is not None or rows is None else rows.astype(np.float64), timed=t is not None)
    theta_m, theta_l = _unwrapped(theta_m, theta_l, float(run.ratio), gaps.before, notes)
    gaps = that_matter(gaps, theta_m)
    notes += gaps.words
    breaks = tuple(sorted({*breaks, *gaps.before.tolist()}))
    return Motion(float(run.ratio), theta_m, theta_l, t, rows, breaks, tuple(notes))


def _once(theta_m: Array, theta_l: Array | None, t: Array | None, notes: list[str]) -> Array:
    """The motor's angle [rad], (n,), missing in rows that are the one before once more, time and all."""
    if t is None:
        return theta_m
    columns = [t, theta_m] if theta_l is None else [t, theta_m, theta_l]
    again = np.concatenate([_as_before(columns, some) for some in stretches(theta_m.size)] or [np.zeros(0, np.int64)])
    if not again.size:
        return theta_m
    notes.append(f"{again.size} of {theta_m.size} rows have time and angles of the row before: taken once.")
    out = room(theta_m.size)
    out[:] = theta_m
    out[again] = np.nan
    return out


def _as_before(columns: Sequence[Array], some: slice) -> Rows:
    """Rows of that stretch in which no column differs from the row before."""
    start = max(some.start - 1, 0)
    same = np.all([np.diff(column[start : some.stop]) == 0 for column in columns], axis=0)
    return np.asarray(np.flatnonzero(same) + start + 1)


def _taken_anew(
    theta_m: Array, theta_l: Array | None, ratio: float, t: Array | None, notes: list[str]
) -> tuple[Array, Array | None]:
    """Both angles [rad], (n,), missing where they repeat the reading before though the shaft moved."""
    other = (None, None) if theta_l is None else (theta_l, theta_m)
    found = repeated(theta_m, other[0], FAR / ratio)
    of_load = repeated(theta_l, other[1], FAR) if theta_l is not None else found
    theta_m = _without(theta_m, found, "theta_m", t, notes)
    return theta_m, None if theta_l is None else _without(theta_l, of_load, "theta_l", t, notes)


def _without(x: Array, found: Repeated, name: str, t: Array | None, notes: list[str]) -> Array:
    if not found.rows.size:
        return x
    notes.append(found.words(name, t))
    out = room(x.size)
    out[:] = x
    out[found.rows] = np.nan
    return out


def _usable(t: Array | None, notes: list[str]) -> Array | None:
    """The time column [s] where it can be one, else None and a note."""
    if t is not None and not increases(t):
        notes.append("The time column does not increase everywhere; it was not used.")
        return None
    if t is not None and (wrong := not_seconds(t)):
        notes.append(f"The time column says {wrong}; it was not used.")
        return None
    return t


def not_seconds(t: Array) -> str:
    """What a time column that goes on says between rows, where that cannot be seconds; "" where it can."""
    apart = float(np.median(np.diff(t[:LOOKED_AT]))) if t.size > 1 else 1.0
    if FASTEST <= apart <= SLOWEST:
        return ""
    return f"{apart:.3g} s between rows, expected {FASTEST:g} to {SLOWEST:g} s: it seems to be in another unit"


def _unwrapped(
    theta_m: Array, theta_l: Array | None, ratio: float, gaps: Rows, notes: list[str]
) -> tuple[Array, Array | None]:
    """Both angles [rad], (n,), unwrapped where they jump by whole turns; across the rows `gaps` the load tells how
    often the motor went round."""
    if theta_l is not None and theta_l.size > 2 and is_wrapped(theta_l, gaps):
        notes.append("theta_l jumps by whole turns; it was unwrapped first.")
        theta_l = unwrap(theta_l, TURN)
    if theta_m.size > 2 and is_wrapped(theta_m, gaps):
        notes.append("theta_m jumps by whole turns; it was unwrapped first.")
        theta_m = unwrap(theta_m, TURN)
        if theta_l is not None:
            theta_m = joined(theta_m, theta_l, ratio, gaps)
    return theta_m, theta_l


def _trusted(columns: list[Array], flags: Array | None) -> tuple[Rows | None, tuple[int, ...]]:
    """The rows whose `columns` are all there and that no flag speaks against, None: all; and the breaks among them."""
    breaks: list[int] = []
    count, size = 0, columns[0].size

    def bits(some: slice) -> Rows:
        return np.zeros(1, np.int64) if flags is None else np.nan_to_num(flags[some]).astype(np.int64)

    def kept(some: slice) -> npt.NDArray[np.bool_]:
        there = np.all([np.isfinite(column[some]) for column in columns], axis=0)
        return np.asarray(there & ((bits(some) & int(UNTRUSTED)) == 0))

    for some in stretches(size):
        keep = kept(some)
        epochs = np.flatnonzero(bits(some) & int(Flag.EPOCH))
        breaks += (count + np.cumsum(keep)[epochs] - keep[epochs]).tolist()
        count += int(np.count_nonzero(keep))
    if count == size:
        return None, tuple(breaks)
    rows, filled = room(count).view(np.int64), 0
    for some in stretches(size):
        found = np.flatnonzero(kept(some)) + some.start
        rows[filled : filled + found.size] = found
        filled += found.size
    return rows, tuple(breaks)


def increases(t: Array) -> bool:
    """Whether each of `t`, (n,), is later than the one before; false where one is missing."""
    return all(np.all(np.diff(t[max(some.start - 1, 0) : some.stop]) > 0) for some in stretches(t.size))
