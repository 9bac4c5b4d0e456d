"""A verdict, and what follows from it."""

from __future__ import annotations

from dataclasses import dataclass

from rig.analysis.tracing.answer import NextRun, Verdict
from rig.analysis.tracing.residual.home import Home


@dataclass(frozen=True)
class Conclusion:
    """The verdict, and what follows from it."""

    verdict: Verdict
    home: Home | None
    lives_in: tuple[str, ...]
    next_run: NextRun | None
    cannot: tuple[str, ...] = ()
