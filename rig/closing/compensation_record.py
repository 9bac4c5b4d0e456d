"""compensation.json, schema hdrig.compensation/1: the load's error without and with the kinematic error fed forward."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rig.analysis.orders.align import Alignment
from rig.closing.compensate import Compared, unlike_the_model
from rig.core.errors import NotReady
from rig.core.units import ARCSEC
from rig.model.gearfile import GearFile
from rig.runfile.manifest import told, write_atomic

NAME = "compensation.json"


def write_compensation(
    folder: Path, found: Sequence[Compared], where: Alignment, gear: GearFile, simulated: bool
) -> None:
    """Write it into `folder`. Raises NotReady when that cannot be written."""
    text = json.dumps(document(found, where, gear, simulated), ensure_ascii=False, indent=1)
    with told(NotReady, f"{folder} cannot be written"):
        write_atomic(folder / NAME, text.encode() + b"\n")


def document(found: Sequence[Compared], where: Alignment, gear: GearFile, simulated: bool) -> dict[str, Any]:
    """Errors in arcsec, curves over the motor turn."""
    return {
        "schema": "hdrig.compensation/1",
        "simulated": simulated,
        "gear": {"serial": gear.serial, "made": gear.made},
        "zero": {"shift_rad": where.shift, "fitted_rad": where.fitted, "u_fitted_rad": where.u_fitted,
                 "sentence": where.sentence},
        "speeds": [
            {
                "speed_rpm": one.speed_rpm,
                "runs": list(one.runs),
                "measured": {
                    name: {"rms": asdict(f.rms), "peak_to_peak": asdict(f.peak_to_peak), "turns": f.turns,
                           "forth_arcsec": (f.error[0] / ARCSEC).round(3).tolist(),
                           "back_arcsec": (f.error[1] / ARCSEC).round(3).tolist()}
                    for name, f in (("without", one.without), ("with", one.with_it))
                },
                "predicted": {"without": asdict(one.expected_without), "with": asdict(one.expected_with)},
                "unlike_the_model": unlike_the_model(one),
                "improvement": {"measured": one.improvement, "predicted": one.expected_improvement},
            }
            for one in found
        ],
    }  # fmt: skip
