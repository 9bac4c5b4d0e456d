"""A run as everything above reads it: columns when asked for, whoever made the folder."""

from __future__ import annotations

import math
from collections.abc import Mapping
from datetime import datetime
from functools import cached_property
from pathlib import Path
from typing import Any, Final

import numpy as np
import pyarrow as pa

from rig.core.errors import DataError, UsageError
from rig.core.few import few
from rig.core.rows import stretches
from rig.runfile import manifest as manifests
from rig.runfile.columns import Array
from rig.runfile.misfits import misfits, misfits_of_ours, mistyped, usable
from rig.runfile.origin import SIM
from rig.runfile.samples import Samples, open_samples
from rig.runfile.text_path import refuse_no_text
from rig.runfile.thermometer import TEMPERATURE, Thermometer, thermometer

TOLD: Final = 8  # names of columns
ANGLES: Final = ("theta_m", "theta_l", "counts_m", "counts_l")


class Run:
    """One run folder, ours or another logger's. Holds no file open; can be sent to another process."""

    def __init__(self, path: Path, manifest: manifests.Manifest, samples: Samples) -> None:
        """`manifest` as it stands in the folder; what of it is of no use, by `misfits`, counts as not said."""
        self.path = path
        self.manifest = usable(manifest)
        self.misfits = (*misfits(manifest), *misfits_of_ours(manifest), *mistyped(manifest))
        self.samples = samples
        self.ratio = manifests.ratio_of(path, manifest)
        self.procedure = manifests.procedure_of(path, manifest)

    @classmethod
    def open(cls, path: Path | str) -> Run:
        """Open the folder at `path`: samples.parquet, else the journal.

        Raises UsageError when schema, procedure or gear.ratio are absent, or contradict the format: no angle at all, a
        unit other than the table's. Raises DataError when the samples are damaged or absent, or their time runs back.
        """
        folder = Path(path)
        refuse_no_text(folder)
        about = manifests.read(folder)
        run = cls(folder, about, open_samples(folder))
        if not any(run.has(name) or (not run.rows and name in run.channels) for name in ANGLES):
            there = f"expected at least one of {', '.join(ANGLES)}, it has {few(run.samples.layout.names, TOLD)}"
            raise UsageError(f"{run.samples.path} has no angle: {there}")
        _refuse_backward_time(run)
        return run

    @property
    def name(self) -> str:
        """The folder's name, by which runs of a campaign are told apart."""
        return self.path.name

    @property
    def uid(self) -> str:
        """What no other run has; "" where the manifest does not say it."""
        said = self.manifest.get("uid")
        return said if isinstance(said, str) else ""

    @property
    def digest(self) -> str:
        """SHA-256 of its samples; "" where the manifest does not say it."""
        return manifests.digest_of(self.manifest)

    @property
    def rows(self) -> int:
        """Samples in the run."""
        return self.samples.rows

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the columns there are, measured or not."""
        return tuple(self.samples.layout.names)

    @property
    def conditions(self) -> Mapping[str, Any]:
        """What was set for this run (`tau_ext` N·m, `output_locked`, `speed_rpm` …); empty when not said."""
        return self.manifest.get("conditions") or {}

    @property
    def declared(self) -> Mapping[str, Any]:
        """What was believed of the gear (`J_m` kg·m², `K` N·m/rad …); empty when not said."""
        return self.manifest.get("declared") or {}

    @property
    def simulated(self) -> bool:
        """True when the samples came from the twin."""
        return self.manifest.get("backend") == SIM

    @property
    def started(self) -> datetime | None:
        """When the run started; None when not said."""
        said = self.manifest.get("started_utc")
        return datetime.fromisoformat(said) if said else None

    @cached_property
    def timing(self) -> Mapping[str, Any]:
        """Loop statistics of timing.json; empty when there are none."""
        try:
            found = manifests.parse(manifests.contents(self.path / "timing.json"))
        except (OSError, ValueError):
            return {}
        return found if isinstance(found, dict) else {}

    def has(self, name: str) -> bool:
        """True when the channel is there and was measured at least once; "temperature" as `column` has it."""
        if name == TEMPERATURE and self.thermometer:
            name = self.thermometer.channel
        return name in self.samples.layout.names and not self.samples.empty(name)

    def column(self, name: str) -> Array | None:
        """One channel, float64, shape (rows,), NaN where not measured; None when `has` says no. New each time.
        "temperature" is that of the gear in °C, whatever the channel is called.
        """
        if not self.has(name):
            return None
        if name == TEMPERATURE and self.thermometer:
            found, factor, more = self.thermometer
            return self.samples.column(found) * factor + more
        return self.samples.column(name)

    @cached_property
    def thermometer(self) -> Thermometer | None:
        """The channel that reads the gear's temperature; None where none has a unit of temperature."""
        return thermometer((name, self.unit(name), self.meaning(name)) for name in self.samples.layout.names)

    def need(self, name: str) -> Array:
        """The channel, or UsageError with the name of what is missing."""
        values = self.column(name)
        if values is None:
            raise UsageError(f"{self.name} has no {name}; it has {', '.join(c for c in self.channels if self.has(c))}")
        return values

    @property
    def flags(self) -> np.ndarray[Any, np.dtype[np.uint32]]:
        """Quality bits of every row, shape (rows,), zero where nothing was said; bits are `rig.core.channels.Flag`."""
        values = self.column("flags")
        return np.zeros(self.rows, np.uint32) if values is None else np.nan_to_num(values).astype(np.uint32)

    def unit(self, name: str) -> str:
        """The unit a column carries, "" when none is said."""
        return self._about(name, b"unit")

    def meaning(self, name: str) -> str:
        """What a column says it is, "" when nothing."""
        return self._about(name, b"meaning")

    def _about(self, name: str, key: bytes) -> str:
        field: pa.Field = self.samples.layout.field(name)
        return str((field.metadata or {}).get(key, b"").decode(errors="replace"))


def _refuse_backward_time(run: Run) -> None:
    t = run.column("t")
    if t is None:
        return
    row, last = 0, -math.inf
    for some in stretches(t.size):
        there = t[some][np.isfinite(t[some])]
        back = np.flatnonzero(np.diff(there, prepend=last) < 0)
        if back.size:
            i = int(back[0])
            before = there[i - 1] if i else last
            raise DataError(
                f"{run.samples.path}: time runs backwards after row {row + i - 1} ({before:.6f} s, then "
                f"{there[i]:.6f} s); expected rows in the order they were measured"
            )
        row += there.size
        last = there[-1] if there.size else last
