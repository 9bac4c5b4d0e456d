"""Where rows are missing: between which of them too long went by for an angle or a turn to go on across."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.core.rows import spread, stretches
from rig.core.units import TURN

Index = npt.NDArray[np.int64]

LONG = 3.5  # usual distances between rows: of a host that logs when it gets to it, two rows may be lost and bridged
TURNED = TURN / 60  # rad of the motor: of order 15 a quarter of a period, and a fit bridges that
IDLE = 1.0  # s: what a motor at rest did in a longer gap nobody knows either
LOOKED_AT = 4000  # steps from which the usual ones are taken: a run of hours has no more to say
TOLD = 5  # gaps told one by one


@dataclass(frozen=True)
class Gaps:
    """Gaps before the rows `before`, (k,): `length` in s, or in rows where the run has no time, (k,)."""

    before: Index
    length: Array
    clock: Array  # (n,) s, or numbers of rows
    timed: bool

    def some(self, which: npt.NDArray[np.bool_]) -> Gaps:
        """Those of `which`, (k,) of bool."""
        return Gaps(self.before[which], self.length[which], self.clock, self.timed)

    @property
    def words(self) -> tuple[str, ...]:
        """One note for people, none without a gap."""
        if not self.before.size:
            return ()
        told = [self._one(i) for i in range(min(self.before.size, TOLD))]
        more = self.before.size - len(told)
        rest = f" and {more} more" if more else ""
        return (f"{'; '.join(told)}{rest}: no turn is taken across a gap.",)

    def _one(self, i: int) -> str:
        start, length = float(self.clock[self.before[i] - 1]), float(self.length[i])
        if self.timed:
            return f"gap of {length:.3g} s at t = {start:.{_places(length)}f} s"
        return f"gap of {length - 1:.0f} rows after row {start:.0f}"


def _places(length: float) -> int:
    """Decimals of a time beside a `length` of so many s."""
    return 1 if length >= 1 else 3


def find_gaps(clock: Array | None, timed: bool) -> Gaps:
    """Steps of `clock`, (n,) s or numbers of rows, that are much longer than usual; none without a clock."""
    if clock is None or clock.size < 3:
        return Gaps(np.empty(0, np.int64), np.empty(0), np.empty(0), timed)
    at = spread(clock.size - 1, LOOKED_AT)
    most = LONG * float(np.median(clock[at + 1] - clock[at]))
    found = [
        start + 1 + np.flatnonzero(np.diff(clock[start : some.stop]) > most)
        for some in stretches(clock.size)
        for start in [max(some.start - 1, 0)]
    ]
    before = np.concatenate(found).astype(np.int64)
    return Gaps(before, clock[before] - clock[before - 1], clock, timed)


def that_matter(gaps: Gaps, theta_m: Array) -> Gaps:
    """The gaps in which the motor, at `theta_m` [rad], (n,), turned too far for a fit to bridge, or that are long."""
    if not gaps.before.size:
        return gaps
    at = spread(theta_m.size - 1, LOOKED_AT)
    at = np.setdiff1d(at, gaps.before - 1)
    went, took = np.abs(theta_m[at + 1] - theta_m[at]), gaps.clock[at + 1] - gaps.clock[at]
    usual = float(went.mean() / took.mean()) if at.size else 0.0
    turned = np.maximum(np.abs(theta_m[gaps.before] - theta_m[gaps.before - 1]), usual * gaps.length)
    return gaps.some((turned > TURNED) | (gaps.timed & (gaps.length > IDLE)))
