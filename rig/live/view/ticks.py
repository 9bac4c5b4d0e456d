"""Round numbers for an axis."""

from __future__ import annotations

import math

STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)


def step_for(span: float, most: int) -> float:
    """The smallest round step that divides `span` > 0 into at most `most` parts."""
    if not (math.isfinite(span) and span > 0 and most > 0):
        raise ValueError(f"an axis over {span} in {most} parts; expected a span above 0 and at least one part")
    rough = span / most
    decade = 10.0 ** math.floor(math.log10(rough))
    return next(s * decade for s in STEPS if s * decade >= rough * (1 - 1e-9))


def ticks(low: float, high: float, most: int = 6, step: float | None = None) -> list[float]:
    """Multiples of a round step within [low, high], both ends included where they are multiples."""
    step = step or step_for(high - low, most)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [k * step + 0.0 for k in range(first, last + 1)]  # + 0.0: no "-0"


def rounded_out(low: float, high: float, most: int = 6) -> tuple[float, float]:
    """The span widened until both ends are ticks of it; a span of nothing gets a width of its own."""
    if high <= low:
        width = max(abs(low) * 0.01, 1e-6)
        low, high = low - width, high + width
    step = 0.0
    while step_for(high - low, most) > step * (1 + 1e-9):  # a wider span may want a wider step
        step = step_for(high - low, most)
        low, high = math.floor(low / step + 1e-9) * step, math.ceil(high / step - 1e-9) * step
    return low, high


def written(value: float, step: float) -> str:
    """A tick's number with the decimals its step needs."""
    decimals = max(0, -math.floor(math.log10(step) + 1e-9))
    if abs(step * 10**decimals - round(step * 10**decimals)) > 1e-6:
        decimals += 1  # a step of 2.5 or 0.025
    return f"{value:.{decimals}f}".replace("-", "−")
