"""Is there anything to recover a run from? Asked by all who would advise it; nothing is opened for it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

NOWHERE = "/nonexistent"  # the ring of a run that has none
RECOVER = "hdrig recover makes it readable"
SAMPLES = "samples.parquet"


def journal_files(folder: Path) -> list[Path]:
    """The journals of a run, oldest first."""
    return sorted(folder.glob("journal-*.arrows"))


def hold_samples(names: Iterable[str]) -> bool:
    """Whether files of these names are samples: where a manifest has to stand beside them, that is a run without it."""
    return any(n.startswith("samples.") or (n.startswith("journal-") and n.endswith(".arrows")) for n in names)


def ring_of(about: Mapping[str, Any]) -> Path:
    """Where rows in shared memory would be."""
    return Path(about.get("ring") or NOWHERE)


def to_recover_from(folder: Path, about: Mapping[str, Any]) -> bool:
    """Whether a journal or a ring is there."""
    return bool(journal_files(folder)) or ring_of(about).exists()


def advice(folder: Path, about: Mapping[str, Any]) -> str:
    """What can be done of a run that was never closed."""
    if to_recover_from(folder, about):
        return RECOVER
    if (folder / SAMPLES).exists():
        return f"its {SAMPLES} is read as it is, and there is no journal to recover more from"
    return "there is no journal to recover it from"
