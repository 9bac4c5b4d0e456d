"""What a manifest promises of its samples, against the samples: how many rows there are, and how time goes in them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from rig.core.numbers import number
from rig.core.rows import Array, spread
from rig.runfile import archive

APART = 5.0  # times: loops that miss ticks stay nearer to their rate, and units of time are at least 60 apart
UNITS = ((1e3, "ms"), (1e6, "µs"), (1e9, "ns"), (1 / 60, "min"))
LOOKED_AT = 4000  # rows
NEAR = 0.2  # share by which a factor may differ from that of a unit


def rows_gone(about: Mapping[str, Any], rows: int) -> str:
    """Says how many of the rows a run was closed with are not among its `rows`; "" when all are, or nobody said."""
    files = about.get("files")
    entry = files.get(archive.NAME) if isinstance(files, Mapping) else None
    closed = number(entry.get("rows") if isinstance(entry, Mapping) else None, number(about.get("rows"), 0.0))
    if closed <= rows:
        return ""
    return f"{closed - rows:.0f} of the {closed:.0f} rows this run was closed with are missing"


def time_untold(about: Mapping[str, Any], t: Array | None) -> str:
    """Says where `t` [s], shape (n,), goes by another measure than the loop's rate [Hz] and the duration [s] in the
    manifest; "" where it does not, or nothing is said. The duration is looked at only where all rows are there."""
    if t is None or t.size < 3:
        return ""
    loop = about.get("loop")
    rate = number(loop.get("rate") if isinstance(loop, Mapping) else None)
    # of a run of hours a few thousand rows tell as much as all, and take no memory
    at = spread(t.size - 1, LOOKED_AT)
    at = at[np.isfinite(t[at]) & np.isfinite(t[at + 1])]
    if at.size < 2:
        return ""
    period, span = float(np.median(t[at + 1] - t[at])), float(t[at[-1] + 1] - t[at[0]])
    duration = number(about.get("duration"))
    if period > 0 and rate > 0 and _apart(period * rate):
        said, factor = (
            f"its rows are {period:.4g} s apart, the manifest says {rate:g} Hz ({1 / rate:.4g} s)",
            period * rate,
        )
    elif span > 0 and duration > 0 and _apart(span / duration) and not rows_gone(about, t.size):
        said, factor = f"it spans {span:.4g} s, the manifest says {duration:.4g} s", span / duration
    else:
        return ""
    unit = next((f": it looks like {unit}" for of, unit in UNITS if abs(factor / of - 1) < NEAR), "")
    return f"t is not in s: {said}{unit}, expected s"


def _apart(factor: float) -> bool:
    return not 1 / APART < factor < APART
