"""One trace from a folder to a result."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rig.analysis.tracing.aligned import aligned
from rig.analysis.tracing.looks import second_looks
from rig.analysis.tracing.outcome.report import report
from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.searched import searched
from rig.analysis.tracing.workers import give_back, one_heap


def trace(folder: Path, hold_out: Sequence[str] = ()) -> Trace:
    """Trace the campaign in `folder`. Raises UsageError when it cannot be read or has too little to fit and test."""
    one_heap()
    campaign = read_campaign(folder)
    give_back()
    campaign, p = aligned(campaign, hold_out)
    first, found = searched(p)
    selected, found = second_looks(first, found, campaign, hold_out)
    return report(selected.p, found, selected.solution, selected.held, selected.scores, selected.words)
