"""The order a wave generator of two lobes makes: where it is another one, an angle may read a part or a multiple."""

from __future__ import annotations

from typing import Final

from rig.analysis.findings.result import Array

LOBES: Final = 2
PARTS: Final = (4, 8)  # where that order comes to stand when both angles read a half, or a quarter
TWICE: Final = 1  # and twice as much as they should
MORE: Final = 3.0  # times order 2: of no gear known here is another order so much larger
BETWEEN: Final = 0.1  # of it: orders that are no multiple, which nothing comes to stand at


def reads_a_part(amplitude: Array) -> str:
    """Why both angles seem to read a half or a quarter, by the amplitudes (k,) of orders from 1 on; "" where not."""
    for order in PARTS:
        if _is_loudest(amplitude, order) and _nothing_between(amplitude, order):
            return (
                f"Order {order} is the largest, next to nothing stands at those that are no multiple of {order // 2}, "
                f"and a wave generator of two lobes makes order {LOBES}: both angles seem to read 1/{order // LOBES} "
                "of what they should (counts per turn, or the quadrature of both encoders)."
            )
    return ""


def may_read_twice(amplitude: Array) -> str:
    """A note where order 1 stands out; "" where it does not."""
    if not _is_loudest(amplitude, TWICE):
        return ""
    return (
        f"Order {TWICE} is the largest, and a wave generator of two lobes makes order {LOBES}: an eccentric encoder of "
        "the motor, or both angles read twice what they should (counts per turn, or the quadrature of both encoders)."
    )


def _is_loudest(amplitude: Array, order: int) -> bool:
    if amplitude.size < max(order, LOBES):
        return False
    size = amplitude[order - 1]
    return bool(size >= amplitude.max() and size > MORE * amplitude[LOBES - 1])


def _nothing_between(amplitude: Array, order: int) -> bool:
    """Whether all orders that are no multiple of half of it are small."""
    others = [size for n, size in enumerate(amplitude, 1) if n % (order // LOBES)]
    return bool(max(others, default=0.0) < BETWEEN * amplitude[order - 1])
