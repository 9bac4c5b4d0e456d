"""NI TDMS, through nptdms. A column is `group/channel`. Units: the property `unit_string`.

A waveform's `wf_increment` is a nominal rate, not a time stamp: it makes no time column.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from rig.runfile.importing.mapping import Dialect
from rig.runfile.importing.table import Table, locate


def read(path: Path, wanted: Sequence[str], dialect: Dialect) -> Table:
    """The wanted columns. Raises UsageError."""
    from nptdms import TdmsFile

    with TdmsFile.open(path) as file:
        if file.file_status.incomplete_final_segment:
            raise EOFError("its last segment is not all there")
        offered = {f"{group.name}/{channel.name}": channel for group in file.groups() for channel in group.channels()}
        found = locate(offered, wanted, path.name)
        columns = {name: np.asarray(offered[full][:]).reshape(-1) for name, full in found.items()}
        units = {name: str(offered[full].properties.get("unit_string", "")) for name, full in found.items()}
    return Table(columns, {name: unit for name, unit in units.items() if unit})
