"""Paths as a page has them: steps of tenths of a pixel, which makes noisy curves a quarter of the size."""

from __future__ import annotations

import itertools
from functools import cache
from typing import Any

import numpy as np
from matplotlib.path import Path

from rig.analysis.findings.result import Array

SURE = 6  # decimals: what is less is rounding's, and must not decide to which tenth a point goes


def steps(points: Array, codes: Any) -> str:
    """Points (n, 2) [px] as relative steps of tenths. `codes` (n,) are matplotlib's: MOVETO, LINETO, and CLOSEPOLY, of
    which the point says nothing.
    """
    tenths = np.rint(10.0 * np.round(points, SURE))
    out, here = list[str](), np.zeros(2)
    for first, end in itertools.pairwise([*np.flatnonzero(codes == Path.MOVETO), len(codes)]):
        closed = bool(codes[end - 1] == Path.CLOSEPOLY)
        piece = tenths[first : end - closed]
        out.append(_relative(np.diff(piece, axis=0, prepend=here[None])) + "z" * closed)
        here = piece[0 if closed else -1]
    return "".join(out)


def _relative(moved: Array) -> str:
    """One m and what is drawn from there, each step [0.1 px] (n, 2); steps of nothing after the first are left out."""
    kept = moved[np.append([True, True], moved[2:].any(axis=1))[: len(moved)]]
    x, y, *lines = kept.ravel().astype(int).tolist()
    start = f"m{_tenths(x)}{_joined(y)}"
    if not lines:
        return start
    # the l is not said again; after an m the numbers alone would mean a line too
    return f"{start}l{_tenths(lines[0])}{''.join(map(_joined, lines[1:]))}"


@cache
def _tenths(value: int) -> str:
    """Steps are short and few of them differ: each is worked out once."""
    whole, tenth = divmod(abs(value), 10)
    text = (str(whole) if whole or not tenth else "") + (f".{tenth}" if tenth else "")
    return f"-{text}" if value < 0 else text


@cache
def _joined(value: int) -> str:
    """The same behind another number: a minus parts them, else a blank does."""
    text = _tenths(value)
    return text if text[0] == "-" else f" {text}"
