"""Are the samples still those that a result was made from? What stands in a result is believed no further than that."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rig.core.errors import DataError, HdrigError, said_of
from rig.runfile.manifest import digest_of, entry
from rig.runfile.remains import SAMPLES

RESULT = "result.json"


def doubt(folder: Path, about: Mapping[str, Any]) -> str:
    """Why the figures of the run in `folder`, whose manifest is `about`, are not to be believed; "" where nothing says
    so. Reads all samples of a run that has a result."""
    if not (folder / RESULT).exists():
        return ""
    for name in (RESULT, SAMPLES):
        if _is_another(folder / name, digest_of(about, name)):
            return f"{name} is not what it was when the run was closed or analysed (see hdrig verify)"
    there, said = (folder / SAMPLES).exists(), entry(about, SAMPLES)
    if (there and said.get("sha256")) or not (there or said):  # a folder of results alone promises no samples
        return ""
    return unreadable(folder)


def quick_doubt(folder: Path, about: Mapping[str, Any]) -> str:
    """The same, looking into the samples only where they are gone, of another size, or younger than the result."""
    try:
        result, samples = (folder / RESULT).stat(), (folder / SAMPLES).stat()
    except OSError:
        return doubt(folder, about)
    size = entry(about, SAMPLES).get("bytes", samples.st_size)
    return doubt(folder, about) if samples.st_mtime > result.st_mtime or size != samples.st_size else ""


def refuse_changed(folder: Path, about: Mapping[str, Any]) -> None:
    """What is made of samples that are not those the run was closed with would be worth nothing. Raises DataError when
    they are others, or cannot be read."""
    if said := changed(folder, about):
        raise DataError(f"{folder / SAMPLES} {said}")


def changed(folder: Path, about: Mapping[str, Any]) -> str:
    """That the samples are not those the run was closed with; "" where they are, or nobody took a hash of them. Raises
    DataError when they cannot be read."""
    from rig.runfile.finalise import describe
    from rig.runfile.manifest import told

    path, said = folder / SAMPLES, digest_of(about)
    if not said or not path.exists():
        return ""
    with told(DataError, f"{path} cannot be read"):
        same = describe(path)["sha256"] == said
    return "" if same else "is not the file this run was closed with (its SHA-256 differs): see hdrig verify"


def unreadable(folder: Path) -> str:
    """Why a run cannot be read, in words; "" where it can. It says nothing of samples that were changed."""
    from rig.runfile.run import Run

    try:
        Run.open(folder)
    except HdrigError as error:
        return said_of(folder, error)
    return ""


def _is_another(path: Path, sha256: str) -> bool:
    from rig.runfile.finalise import describe

    try:
        return bool(sha256) and path.exists() and describe(path)["sha256"] != sha256
    except OSError:  # what cannot be read is said by those who read it
        return False
