"""What the sentinels of a campaign say of the rig: whether it changed between them, figure by figure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from rig.analysis.across_runs.sentinel import WATCHED, compare
from rig.analysis.findings.collected import true_minus
from rig.analysis.findings.result import Estimate
from rig.campaign.journal import Journal
from rig.catalogue.figures import Figure, common_label, figures
from rig.core.errors import HdrigError

ALIKE = ("tau_ext", "output_locked", "depth_mm")  # conditions in which only equal sentinels are set beside each other


def lines(journal: Journal) -> Iterator[str]:
    """One sentence for each watched figure of two or more sentinels that are alike; nothing without any."""
    for entries in _groups(journal.book["runs"]):
        found = []
        for entry in entries:
            try:
                found.append(figures(journal.folder / entry["run"]))
            except HdrigError as error:
                yield f"sentinel left out: {error}"
        watched = [_watched(found, name) for name in WATCHED]
        anew = len({entry["conditions"]["assembly"] for entry in entries}) > 1
        where = ", the wave generator fitted anew between them" if anew else ""
        for one in compare([[w[k] for w in watched if w] for k in range(len(found))]):
            yield true_minus(f"sentinels{where}: {one.sentence}")


def _groups(entries: Sequence[Mapping[str, Any]]) -> list[list[Mapping[str, Any]]]:
    """Sentinels that were made, those of one procedure, parameters and conditions together, in the order made."""
    groups: dict[str, list[Mapping[str, Any]]] = {}
    for entry in entries:
        if "sentinel" in (entry["kind"], entry["procedure"]) and entry["status"] == "done":
            conditions = [entry["conditions"].get(name) for name in ALIKE]
            groups.setdefault(str((entry["procedure"], entry["parameters"], conditions)), []).append(entry)
    return [group for group in groups.values() if len(group) > 1]


def _watched(runs: Sequence[Mapping[str, Figure]], name: str) -> list[Estimate]:
    """The figure `name` of every run, under one label; empty where a run lacks it, or was rejected."""
    found = [run[name] for run in runs if name in run and not run[name].rejected]
    label = common_label(found) if found else ""
    alike = len(found) == len(runs)
    return [Estimate(name, label, f.value, f.unit, (f.low, f.high), "") for f in found] if alike else []
