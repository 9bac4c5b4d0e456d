"""Which runs a verdict does not go by, said with it: nothing missing in half of the runs is no clean bill for all."""

from __future__ import annotations

from typing import Final

from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.outcome.told import listed

NAMED: Final = 3  # of them in a sentence


def ruled(trace: Trace) -> str:
    """The verdict for people, and which runs it does not go by."""
    return f"{trace.verdict.sentence} {without(trace)}".strip()


def without(trace: Trace) -> str:
    """How many runs of how many were left out, and some of them by name; "" where none was."""
    if not trace.left_out:
        return ""
    few, more = trace.left_out[:NAMED], len(trace.left_out) - NAMED
    names = listed([*few, *([f"{more} more"] if more > 0 else [])])
    return f"{counted_out(trace)} left out: {names}."


def counted_out(trace: Trace) -> str:
    """ "1 of 8 runs was"."""
    out = len(trace.left_out)
    return f"{out} of {trace.read + out} runs {'was' if out == 1 else 'were'}"
