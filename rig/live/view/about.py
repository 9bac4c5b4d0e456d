"""What the manifest says of the run that is drawn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rig.core.numbers import number, stated
from rig.runfile.manifest import ratio_of, read
from rig.runfile.origin import SIM


@dataclass(frozen=True)
class About:
    """One run, in the words of its manifest."""

    uid: str
    title: str  # what people call it, with hyphens
    procedure: str  # with underscores, "other" among them
    gear: str  # serial number
    ratio: float  # N
    simulated: bool
    locked: bool  # the output is
    stiffness: float  # N·m/rad at the output, declared; 0 where nobody says
    rate: float  # Hz of the loop; 0 where nobody says
    mode: str  # which loop the drive closed: torque | velocity | position
    folder: str
    started: str  # UTC, ISO 8601

    @property
    def banner(self) -> str:
        """SIMULATED where it is; "" on a real rig."""
        return "SIMULATED" if self.simulated else ""


def about(folder: Path) -> About:
    """Raises UsageError when the folder is no run."""
    said: Mapping[str, Any] = read(folder)
    procedure = str(said.get("procedure", "other")).replace("-", "_")
    gear, loop, conditions = _part(said, "gear"), _part(said, "loop"), _part(said, "conditions")
    return About(
        uid=str(said.get("uid") or folder.name),
        title=str(said.get("label") or procedure.replace("_", "-")),
        procedure=procedure,
        gear=str(gear.get("serial") or "gear"),
        ratio=ratio_of(folder, said),
        simulated=said.get("backend") == SIM,
        locked=bool(conditions.get("output_locked")),
        stiffness=max(stated(_part(said, "declared").get("K"), 0.0), 0.0),
        rate=max(number(loop.get("rate"), 0.0), 0.0),
        mode=str(loop.get("mode") or "torque"),
        folder=folder.name,
        started=str(said.get("started_utc") or ""),
    )


def _part(said: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    part = said.get(key)
    return part if isinstance(part, dict) else {}
