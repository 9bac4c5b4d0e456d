"""What the model lacks by the runs of a campaign, kept beside them as trace.json and report.html."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from rig.core.errors import NotReady
from rig.core.loading import load
from rig.process.ctrl_c import uninterrupted
from rig.runfile.manifest import told, utc_now

if TYPE_CHECKING:
    from rig.analysis.tracing.outcome.result import Trace

PAGE = "rig.report.trace.page"


def trace_folder(folder: Path) -> Trace:
    """Trace all runs in `folder` and write there what was found. Raises NotReady where it cannot be written."""
    from rig.analysis.tracing.trace import trace

    found = trace(folder)
    page = page_of(found, folder)
    with told(NotReady, f"what the trace found cannot be written to {folder}"):
        keep(folder, found, page)
    return found


def page_of(found: Trace, campaign: Path) -> str:
    """The page of a trace as text. It takes seconds: made before anything is written, so that a word to stop meanwhile
    leaves all as it was."""
    load(PAGE)  # only now: a trace needs all the memory there is, and a page has much to import
    from rig.process.software import software
    from rig.report.trace.campaign import provenance
    from rig.report.trace.page import render

    return render(found, provenance(campaign, software(), utc_now()))


def keep(folder: Path, found: Trace, page: str) -> tuple[Path, Path]:
    """Write trace.json and the page into `folder`, files of one trace whatever signal comes; their paths. Raises
    OSError."""
    from rig.analysis.tracing.outcome.record import write_trace
    from rig.report.trace.page import put

    with uninterrupted():
        report = put(folder, page)
        return write_trace(folder / "trace.json", found), report
