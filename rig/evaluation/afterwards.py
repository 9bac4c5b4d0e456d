"""What follows the last run of a campaign, by the name of its plan: a gear file, or the page of a sweep."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from rig.campaign.journal import read_journal
from rig.core.errors import Exit, UsageError
from rig.evaluation.identification import identify
from rig.evaluation.run import exit_of
from rig.evaluation.sweep import Sweep, assembly_sweep_of, load_sweep_of
from rig.evaluation.to_identify import Say
from rig.model.fourier import PAPER_ORDERS
from rig.runfile.listing import runs_in

if TYPE_CHECKING:
    from rig.analysis.findings.result import Result

GEAR = "gear.toml"  # in the campaign's folder


@dataclass(frozen=True)
class Followed:
    """What was made of a campaign: for people, and how it ended."""

    lines: Sequence[str] = ()
    exit: Exit = Exit.PASS
    result: Result | None = None  # of the campaign as a whole, where it has one


def nothing(folder: Path, say: Say) -> Followed:
    """What follows most campaigns."""
    return Followed()


def to_gear_file(folder: Path, say: Say) -> Followed:
    """Parameters with intervals, and the gear file in the campaign's folder. Raises UsageError where one is already."""
    from rig.model import gearfile

    out = folder / GEAR
    if out.exists():
        raise UsageError(f"{out} exists already; give the name of a new file")
    found = identify(runs_in(folder), PAPER_ORDERS, say)
    gearfile.write(out, found.file)
    return Followed([*found.lines(), f"gear file {out}"], found.exit)


def to_load_law(folder: Path, say: Say) -> Followed:
    """Peak to peak against load, in the summary and as a report."""
    return _swept(folder, load_sweep_of(folder))


def to_depths(folder: Path, say: Say) -> Followed:
    """Peak to peak by depth with the reproducibility band, in the summary and as a report."""
    return _swept(folder, assembly_sweep_of(folder))


def _swept(folder: Path, sweep: Sweep | None) -> Followed:
    if sweep is None:
        return Followed(["no run of the sweep was analysed: there is nothing to compare"], Exit.INCOMPLETE)
    from rig.report.text.result import lines

    said = [*sweep.lines, *lines(sweep.result, folder.name, sweep.simulated), f"report {folder / 'report.html'}"]
    return Followed(said, exit_of(sweep.result), sweep.result)


AFTER: Mapping[str, Callable[[Path, Say], Followed]] = {
    "identify": to_gear_file,
    "load-sweep": to_load_law,
    "assembly-sweep": to_depths,
}


def afterwards(folder: Path, say: Say) -> Followed:
    """Whatever follows the complete campaign in `folder`. Raises HdrigError."""
    return AFTER.get(str(read_journal(folder).book["name"]), nothing)(folder, say)
