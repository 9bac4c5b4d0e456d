"""What the analysis needs of a run, and the rows of it that can be trusted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from rig.analysis.angle import ARCSEC, RPM, TURN, is_wrapped, transmission_error, unwrap
from rig.analysis.result import Array
from rig.core.channels import UNTRUSTED, Flag

FASTEST = 1e-7  # s between rows: no encoder is read faster, so the column is not in s
SLOWEST = 60.0  # s between rows: nothing that turns is recorded more slowly


class Source(Protocol):
    """A run as `rig.runfile` gives it. A column is float64 with NaN where nothing was measured, None when absent."""

    def column(self, name: str) -> Array | None: ...

    def has(self, name: str) -> bool: ...

    @property
    def manifest(self) -> Mapping[str, Any]: ...

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

    `breaks` are the rows before which an encoder was re-referenced: angles do not join across them.
    """

    ratio: float
    theta_m: Array
    theta_l: Array | None
    t: Array | None
    rows: npt.NDArray[np.int64] | None  # which rows of the run these are; None: all
    breaks: tuple[int, ...] = ()
    notes: tuple[str, ...] = ()

    def error_arcsec(self, lo: int, hi: int) -> Array:
        """θ̃ of rows lo..hi, arcsec at the output      [ghorbel2001, Eq. 1]"""
        assert self.theta_l is not None
        return transmission_error(self.theta_m[lo:hi], self.theta_l[lo:hi], self.ratio) * ARCSEC

    def pick(self, column: Array | None) -> Array | None:
        """The same rows of another column of the run."""
        return column if column is None or self.rows is None else column[self.rows]

    def speed_rpm(self, lo: int, hi: int) -> float:
        """Mean motor speed between two rows, rpm, signed; NaN without time."""
        if self.t is None or hi <= lo or self.t[hi] == self.t[lo]:
            return float("nan")
        return float((self.theta_m[hi] - self.theta_m[lo]) / (self.t[hi] - self.t[lo])) * RPM


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
    if theta.size > 2 and is_wrapped(theta):
        notes.append(f"theta_{side} jumps by whole turns; it was unwrapped first.")
        theta = unwrap(theta, TURN)
    return theta


def motion_of(run: Source) -> Motion | None:
    """The trusted rows of `run`; None when it has no motor angle at all."""
    notes: list[str] = []
    theta_m, theta_l = _angle(run, "m", notes), _angle(run, "l", notes)
    if theta_m is None:
        return None
    t = run.column("t")
    keep = np.isfinite(theta_m)
    if theta_l is not None:
        keep &= np.isfinite(theta_l)
    if t is not None:
        keep &= np.isfinite(t)
    flags_column = run.column("flags")
    breaks: tuple[int, ...] = ()
    if flags_column is not None:
        flags = np.nan_to_num(flags_column).astype(np.int64)
        keep &= (flags & int(UNTRUSTED)) == 0
        epochs = np.flatnonzero(flags & int(Flag.EPOCH))
        breaks = tuple(int(b) for b in np.cumsum(keep)[epochs] - keep[epochs])
    rows = None
    if not keep.all():
        rows = np.flatnonzero(keep)
        lost = keep.size - rows.size
        notes.append(
            f"{lost} of {keep.size} rows left out: an angle was missing, stale or frozen, or the guard had tripped."
        )
        theta_m, theta_l = theta_m[rows], None if theta_l is None else theta_l[rows]
        t = None if t is None else t[rows]
    if t is not None and t.size > 1 and not np.all(np.diff(t) > 0):
        notes.append("The time column does not increase everywhere; it was not used.")
        t = None
    if t is not None and t.size > 1 and not FASTEST <= (t[-1] - t[0]) / (t.size - 1) <= SLOWEST:
        notes.append(f"The time column says {(t[-1] - t[0]) / (t.size - 1):.3g} s between rows; it was not used.")
        t = None
    return Motion(float(run.ratio), theta_m, theta_l, t, rows, breaks, tuple(notes))
