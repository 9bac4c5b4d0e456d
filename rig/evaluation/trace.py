"""What the model lacks by the runs of a campaign, kept beside them as trace.json and report.html."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from rig.core.errors import NotReady
from rig.runfile.manifest import told, utc_now

if TYPE_CHECKING:
    from rig.analysis.tracing.outcome.result import Trace


def trace_folder(folder: Path) -> Trace:
    """Trace all runs in `folder` and write there what was found. Raises NotReady where it cannot be written."""
    from rig.analysis.tracing.outcome.record import write_trace
    from rig.analysis.tracing.trace import trace
    from rig.process.software import software
    from rig.report.trace.campaign import provenance
    from rig.report.trace.page import write

    found = trace(folder)
    with told(NotReady, f"what the trace found cannot be written to {folder}"):
        write_trace(folder / "trace.json", found)
        write(folder, found, provenance(folder, software(), utc_now()))
    return found
