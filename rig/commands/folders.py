"""Run folders named on the command line."""

from __future__ import annotations

from pathlib import Path

from rig.core.errors import UsageError


def expand(paths: list[Path]) -> list[Path]:
    """Run folders as given; a folder that is no run gives the runs below it. Raises UsageError when there are none."""
    found: list[Path] = []
    for path in paths:
        inside = [path] if (path / "manifest.json").exists() else sorted(p.parent for p in path.rglob("manifest.json"))
        if not inside:
            what = (
                "is neither a run folder nor holds any (no manifest.json in it)" if path.exists() else "does not exist"
            )
            raise UsageError(f"{path} {what}")
        found += inside
    return found
