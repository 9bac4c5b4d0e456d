"""One trace from a folder to a result."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from rig.analysis.tracing.aligned import aligned
from rig.analysis.tracing.looks import second_looks
from rig.analysis.tracing.outcome.report import report
from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.searched import searched
from rig.process.workers import give_back, one_heap


def trace(folder: Path, hold_out: Sequence[str] = (), say: Callable[[str], None] = lambda text: None) -> Trace:
    """Trace the campaign in `folder`; what it is at is told to `say`. Raises UsageError when it cannot be read or has
    too little to fit and test."""
    one_heap()
    campaign = read_campaign(folder)
    give_back()
    say(f"{len(campaign.runs)} runs read; what do repeats differ by, and what does the paper's model leave?")
    campaign, p = aligned(campaign, hold_out)
    say("which of the library's effects do fitted runs want, and do unseen ones vouch for?")
    first, found = searched(p)
    say("what may that have missed?")
    selected, found = second_looks(first, found, campaign, hold_out)
    say("where does what is left live, and where does it act?")
    return report(selected.p, found, selected.solution, selected.held, selected.scores, selected.words)
