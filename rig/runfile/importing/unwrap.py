"""A counter that starts again at its end, made to run on; and the look for one that nobody declared."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]

SMOOTH = 0.25  # of a modulus: a column whose ordinary steps are longer cannot be told from one that wraps
NEAR = 0.02  # of a modulus: how near to it a jump must be, or five ordinary steps when that is more


def unwrap(raw: Array, modulus: float) -> Array:
    """`raw`, shape (n,), with steps of a full `modulus` taken out; the first value stays. Whole numbers stay exact.

    It does not matter whether the counter is signed or unsigned. A true step must be less than half the modulus.
    """
    if raw.dtype.kind != "i":
        return np.asarray(np.unwrap(raw, period=modulus))
    whole = int(modulus)
    steps = (np.diff(raw) + whole // 2) % whole - whole // 2
    return np.concatenate([raw[:1], raw[0] + np.cumsum(steps)])


def wrapped_at(raw: Array, candidates: Iterable[float], skip: Array) -> tuple[int, float, float] | None:
    """(row after the jump, jump, modulus) of the largest step of `raw` when it is nearly a candidate modulus, or None.

    `skip`, shape (n − 1,), marks steps over a gap in time, where a long way says nothing. A single wrong value (there
    and back) is no wrap, and neither is a column that spans more than the modulus.
    """
    values = raw.astype(np.float64)
    steps = np.where(skip, 0.0, np.diff(values))
    at = int(np.argmax(np.abs(steps)))
    jump = float(steps[at])
    stays = float(np.median(values[at + 1 : at + 4]) - np.median(values[max(0, at - 2) : at + 1]))
    if abs(stays - jump) > abs(jump) / 2:
        return None
    usual = float(np.percentile(np.abs(steps), 95)) if steps.size > 20 else float(np.median(np.abs(steps)))
    span = float(np.ptp(values))
    near = [m for m in candidates if abs(jump) > m / 2 and usual < SMOOTH * m and span <= m * (1 + NEAR)]
    near = [m for m in near if abs(abs(jump) - m) <= max(5 * usual, NEAR * m)]
    return (at + 2, jump, min(near, key=lambda m: abs(abs(jump) - m))) if near else None
