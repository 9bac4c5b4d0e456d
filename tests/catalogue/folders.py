"""Run folders with a manifest and a result and nothing else, for the catalogue."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

MANIFEST: dict[str, Any] = {
    "schema": "hdrig.run/1",
    "procedure": "kinematic_error",
    "status": "completed",
    "backend": "can",
    "gear": {"ratio": 50, "serial": "SN1"},
    "conditions": {"speed_rpm": 9.6, "tau_ext": 0.0, "assembly": 1},
    "verdict": "PASS",
    "duration": 101.0,
}


def run(root: Path, day: str, number: int = 0, value: float = 90.0, half: float | None = 0.3, **changes: Any) -> Path:
    """A folder by date, `value` ± `half` arcsec its peak to peak; `changes` go into the manifest."""
    name = str(changes.pop("name", "kinematic_error_peak_to_peak"))
    started = f"{day}T{6 + number // 60:02d}:{number % 60:02d}:00+00:00"
    kind = str(changes.get("procedure", "kinematic-error"))[:40].encode(errors="replace").decode()  # half a pair: "?"
    folder = root / day / f"{number:04d}-{kind}-{len(changes)}"
    folder.mkdir(parents=True)
    manifest = {**MANIFEST, "uid": f"{day}-{number}", "started_utc": started, **changes}
    (folder / "manifest.json").write_text(json.dumps(manifest))
    ci95 = [None, None] if half is None else [value - half, value + half]
    figure = {
        "label": "Kinematic error, peak to peak",
        "value": value,
        "unit": "arcsec",
        "ci95": ci95,
        "how": "made up",
    }
    result = {"schema": "hdrig.result/1", "verdict": "PASS", "estimates": {name: figure}}
    (folder / "result.json").write_text(json.dumps(result))
    return folder
