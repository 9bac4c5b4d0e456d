"""A manifest.json damaged or gone → a minimal one of what bench.toml and the samples say; a damaged file stays."""

from __future__ import annotations

import shutil
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pyarrow as pa

from rig.core.errors import DataError, UsageError
from rig.core.kinds import OTHER
from rig.core.numbers import stated
from rig.runfile import manifest
from rig.runfile.columns import COMMANDED
from rig.runfile.process import sole_writer
from rig.runfile.samples import open_samples

BENCH = "bench.toml"
LEAST = f'{{"schema": "{manifest.SCHEMA}", "procedure": "{OTHER}", "gear": {{"ratio": 50}}}}'


def rebuild(folder: Path, damage: manifest.Damaged) -> manifest.Manifest:
    """Put a minimal manifest in place of the one that is no JSON, as `damage` says, and return it.

    Raises UsageError where no bench.toml says the gear's ratio or there are no samples, DataError when those cannot be
    read or nothing can be written, NotReady while the run is being recorded.
    """
    gear = _gear(folder)
    if not stated(gear.get("ratio")) > 0.0:
        raise UsageError(
            f"{folder / manifest.NAME} {damage.what}, and no {BENCH} beside it says gear.N to make it anew by; write "
            f"one with at least {LEAST}"
        )
    layout = open_samples(folder).layout
    with manifest.told(DataError, f"{folder / manifest.NAME} cannot be made anew"), sole_writer(folder):
        kept = "" if isinstance(damage, manifest.Missing) else f"; the old file is {_keep(folder)}"
        note = f"{manifest.NAME} {damage.what} and was rebuilt from {BENCH} and the samples"
        about = {
            "schema": manifest.SCHEMA,
            "procedure": OTHER,
            "status": "interrupted",
            "exit_reason": f"{note}: procedure, conditions and how the run ended are not known{kept}",
            "gear": gear,
            **_recorded_as(layout),
        }
        manifest.write(folder, about)
    return about


def _gear(folder: Path) -> dict[str, Any]:
    """What bench.toml says of it, in a manifest's words; empty where there is none that can be read."""
    try:
        found = tomllib.loads(manifest.contents(folder / BENCH).decode()).get("gear")
    except (OSError, ValueError):
        return {}
    if not isinstance(found, Mapping):
        return {}
    gear = {key: found[key] for key in ("serial", "output") if isinstance(found.get(key), str)}
    return {"ratio": stated(found.get("N")), **gear}


def _recorded_as(layout: pa.Schema) -> dict[str, Any]:
    """Backend and mode of the drive, by the metadata and the names of the columns."""
    backend = (layout.metadata or {}).get(b"backend", b"").decode(errors="replace")
    mode = next((mode for mode, names in COMMANDED.items() if names["tau_ask"][0] in layout.names), "torque")
    return {**({"backend": backend} if backend else {}), "loop": {"mode": mode}}


def _keep(folder: Path) -> str:
    """Copy the damaged file under a name of its own and return that: nothing is overwritten, and the folder is one of a
    run at any time."""
    number = 1
    while (kept := folder / f"manifest-damaged-{number}.json").exists():
        number += 1
    with open(folder / manifest.NAME, "rb") as damaged, open(kept, "xb") as file:
        shutil.copyfileobj(damaged, file)
    return kept.name
