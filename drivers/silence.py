"""Which of a device's messages stays away while its others come."""

from __future__ import annotations

from collections.abc import Mapping

UNANSWERED = 2.5  # periods without a reading: one frame may be lost, two may not


def missing(heard: Mapping[str, float], period: float) -> str:
    """In words, from the time [s] each message came last and the `period` s they are expected in; "" when all come, or
    none does.
    """
    newest = max(heard.values(), default=0.0)
    late = [name for name, t in heard.items() if newest - t > UNANSWERED * period]
    there = [name for name in heard if name not in late]
    return f"{' and '.join(late)} stays away while {' and '.join(there)} comes" if late else ""
