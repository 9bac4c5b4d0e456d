"""What follows the last run of a campaign, by the name of its plan: a gear file, or the page of a sweep.

`python -m rig.commands.afterwards FOLDER` makes it of a campaign that is complete: so the control process behind the
console starts it, which goes on reading its instruments.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from pathlib import Path

from rig.campaign.journal import read_journal
from rig.core.errors import HdrigError


def nothing(folder: Path) -> int:
    """What follows most campaigns."""
    return 0


def to_gear_file(folder: Path) -> int:
    """Parameters with intervals, on stdout and in the campaign's folder."""
    from rig.commands.identify import identify

    return identify([folder], folder / "gear.toml")


def to_load_law(folder: Path) -> int:
    """Peak to peak against load, on stdout, in the summary and as a report."""
    from rig.commands.sweep_report import load_sweep_of

    return load_sweep_of(folder)


def to_depths(folder: Path) -> int:
    """Peak to peak by depth with the reproducibility band, on stdout, in the summary and as a report."""
    from rig.commands.sweep_report import assembly_sweep_of

    return assembly_sweep_of(folder)


AFTER: Mapping[str, Callable[[Path], int]] = {
    "identify": to_gear_file,
    "load-sweep": to_load_law,
    "assembly-sweep": to_depths,
}


def afterwards(folder: Path) -> int:
    """Whatever follows the campaign in `folder`; the exit code. Raises HdrigError."""
    return AFTER.get(str(read_journal(folder).book["name"]), nothing)(folder)


if __name__ == "__main__":
    try:
        sys.exit(afterwards(Path(sys.argv[1])))
    except HdrigError as error:
        print(f"hdrig: {error}", file=sys.stderr)
        sys.exit(int(error.exit))
