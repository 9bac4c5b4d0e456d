"""Was the same file imported before? A second run folder of it would count as a repeat, and is none."""

from __future__ import annotations

import hashlib
from pathlib import Path

from rig.core.errors import HdrigError, UsageError
from rig.runfile import manifest
from rig.runfile.finalise import describe
from rig.runfile.importing.mapping import Mapping
from rig.runfile.importing.write import MAPPING_COPY
from rig.runfile.listing import run_folders


def refuse_again(source: Path, mapping: Mapping, root: Path) -> None:
    """Raises UsageError where below `root` lies a run made of the same bytes by the same mapping."""
    with manifest.told(UsageError, f"{source} cannot be read"):
        wanted = describe(source)["sha256"], hashlib.sha256(mapping.text.encode()).hexdigest()
    for folder in run_folders(str(root)):
        if _made_of(Path(folder)) == wanted:
            raise UsageError(
                f"{source.name} was imported by this mapping before, as {folder}; a second run of it would pass for a "
                "repeat (--again makes one all the same)"
            )


def _made_of(folder: Path) -> tuple[object, object]:
    """Hashes of the file and the mapping that a run folder was made of; None where it says none."""
    try:
        about = manifest.read(folder)
    except HdrigError:
        return None, None
    made = about.get("import")
    mapping = about.get("files", {}).get(MAPPING_COPY, {})
    return made.get("sha256") if isinstance(made, dict) else None, mapping.get("sha256")
