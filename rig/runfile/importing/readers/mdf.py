"""ASAM MDF, through asammdf. A column is a channel, the master (time) included; `group/channel` where the name stands
in several groups. Units and the start time are the file's."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rig.runfile.importing.mapping import Dialect
from rig.runfile.importing.table import Array, Table, locate
from rig.runfile.manifest import SIMULATED


def read(path: Path, wanted: Sequence[str], dialect: Dialect) -> Table:
    """The wanted columns. Raises UsageError."""
    from asammdf import MDF
    from asammdf.blocks.utils import MdfException

    try:
        with MDF(path) as file:
            channels = _channels(file)
            found = locate([name for name, _ in channels], wanted, path.name)
            at = dict(channels)
            signals = {name: file.get(group=at[full][0], index=at[full][1]) for name, full in found.items()}
            columns = {name: _values(signal) for name, signal in signals.items()}
            started = file.header.start_time
            titles = [getattr(group.channel_group, "acq_name", "") for group in file.groups]
    except MdfException as error:
        raise ValueError(str(error)) from None
    units = {name: s.unit for name, s in signals.items() if s.unit}
    return Table(columns, units, started, simulated=SIMULATED in titles)


def _channels(file: Any) -> list[tuple[str, tuple[int, int]]]:
    """(group/channel, (group number, channel number)); a name can stand twice, even in one group."""
    titles = [getattr(group.channel_group, "acq_name", "") or f"group {g}" for g, group in enumerate(file.groups)]
    titles = [f"{title} {g}" if titles.count(title) > 1 else title for g, title in enumerate(titles)]
    return [
        (f"{titles[g]}/{channel.name}", (g, c))
        for g, group in enumerate(file.groups)
        for c, channel in enumerate(group.channels)
    ]


def _values(signal: Any) -> Array:
    """The samples; those the logger marked invalid are null."""
    invalid = getattr(signal, "invalidation_bits", None)
    if invalid is None or not np.any(invalid):
        return np.asarray(signal.samples)
    return np.where(np.asarray(invalid, dtype=bool), np.nan, signal.samples)
