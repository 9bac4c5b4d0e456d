"""Time: from a column of stamps to seconds since the first, its UTC anchor, its period, jitter and gaps."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from rig.core.errors import UsageError
from rig.runfile.importing.channel import ChannelMap
from rig.runfile.importing.units import UNITS

Array = npt.NDArray[Any]

GAP = 3.0  # periods: at least two samples in a row are not there
EPOCH = (1.0e9, 2.2e9)  # s: 2001 to 2039 in Unix time; an instrument's uptime never gets there
EPOCH_END = 5.0e9  # s: 158 years is neither an uptime nor, from 1970 or 1904, a date anybody has logged


class Stamps(NamedTuple):
    """`t`, shape (n,), in s from 0; `first` the first stamp as the file has it [s]; `utc` of it where it is a date."""

    t: Array
    first: float
    utc: datetime | None


def stamps(raw: Array, channel: ChannelMap, unit: str) -> Stamps:
    """Seconds since the first stamp. Subtracted before scaled, so that whole numbers lose nothing."""
    if raw.dtype.kind == "M":
        ns = raw.astype("datetime64[ns]").astype(np.int64)
        first = float(ns[0]) * 1e-9
        return Stamps(
            (ns - ns[0]) * 1e-9, first, datetime.fromtimestamp(first, UTC) if 0 <= first < EPOCH_END else None
        )
    factor = (UNITS[unit].factor or 1.0) * channel.terms[0].scale
    t = (raw - raw[0]) * factor
    first = float(raw[0]) * factor
    utc = datetime.fromtimestamp(first, UTC) if EPOCH[0] <= first <= EPOCH[1] else None
    return Stamps(np.asarray(t, dtype=np.float64), first, utc)


def check_order(raw: Array, unit: str, file: str, drop: bool) -> Array:
    """Which rows to keep, shape (n,). Raises UsageError for time that runs backwards, or stands still unasked.

    Two rows at one time cannot both be right, and a speed between them is infinite: refused unless the mapping drops
    the second.
    """
    steps = np.diff(raw)
    zero = np.zeros(1, steps.dtype)[0]
    back = np.flatnonzero(steps < zero)
    if back.size:
        row = int(back[0])
        raise UsageError(
            f"{file}: time runs backwards {back.size} times, first at row {row + 2}: "
            f"{show(raw[row])} {unit} is followed by {show(raw[row + 1])} {unit}"
        )
    same = np.flatnonzero(steps == zero)
    if same.size and not drop:
        row = int(same[0])
        raise UsageError(
            f"{file}: {same.size} rows have the time stamp of the row before, first row {row + 2} "
            f'({show(raw[row + 1])} {unit}); set channels.t.duplicates = "drop" to keep the first of each'
        )
    keep = np.ones(len(raw), dtype=bool)
    keep[same + 1] = False
    return keep


def show(value: Any) -> str:
    """A stamp as text, all its digits."""
    return str(value) if isinstance(value, np.datetime64) else repr(value.item())


def facts(t: Array) -> dict[str, float]:
    """Period and gaps of `t`, shape (n,), n ≥ 2 [s]; `largest_gap_row` is the row after it, counted from 1."""
    steps = np.diff(t)
    median = float(np.median(steps))
    gaps = steps > GAP * median
    found = {"period_min": float(steps.min()), "period_median": median, "period_max": float(steps.max())}
    found |= {"span": float(t[-1]), "gaps": int(gaps.sum())}
    if gaps.any():
        found |= {"largest_gap": float(steps.max()), "largest_gap_row": int(np.argmax(steps)) + 2}
    return found


def notes(found: dict[str, float]) -> list[str]:
    """The facts as sentences for the manifest."""
    low, mid, high = (found[f"period_{k}"] * 1e3 for k in ("min", "median", "max"))
    said = [f"sample period {mid:.4g} ms median, {low:.4g} ms least, {high:.4g} ms most"]
    if found["gaps"]:
        many = "1 gap in time" if found["gaps"] == 1 else f"{found['gaps']} gaps in time"
        where = f"the largest {found['largest_gap']:.4g} s, before row {found['largest_gap_row']}"
        said.append(f"{many} longer than {GAP:g} periods, {where}")
    return said
