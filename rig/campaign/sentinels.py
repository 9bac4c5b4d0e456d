"""What the sentinels of a campaign say of the rig: whether it changed between them, figure by figure."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from rig.analysis.across_runs.sentinel import WATCHED, compare
from rig.analysis.findings.collected import true_minus
from rig.analysis.findings.result import Estimate
from rig.campaign.journal import Journal
from rig.catalogue.figures import Figure, common_label, figures
from rig.core.errors import HdrigError
from rig.core.quantiles import Z95
from rig.procedures.constant_torque import ConstantTorque
from rig.procedures.open_loop import FOUND
from rig.procedures.sentinel import Sentinel

TORQUE = "mean_motor_torque"
FINDING = (Sentinel.name, ConstantTorque.name)  # procedures that find their torque where none is given
ALIKE = ("tau_ext", "output_locked", "depth_mm")  # conditions in which only equal sentinels are set beside each other

NOT_COMPARED = (
    "sentinels: each found its own torque, so speed and θ̃ at it are not compared; torque = … [N·m] in the sentinel's "
    "'with' gives all of them the same."
)


def lines(journal: Journal) -> Iterator[str]:
    """One sentence for each watched figure of two or more sentinels that are alike; nothing without any.

    Where each found its own torque, that torque alone is compared, with what finding it leaves open: a torque as little
    off as that makes another speed, and what depends on the speed is another with it.
    """
    for entries in _groups(journal.book["runs"]):
        found = []
        for entry in entries:
            try:
                found.append(figures(journal.folder / entry["run"]))
            except HdrigError as error:
                yield f"sentinel left out: {error}"
        anew_found = _finds_torque(entries[0])
        watched = [_watched(found, name) for name in WATCHED]
        if anew_found:
            watched = [[_as_found(e) for e in one] for one in watched if one and one[0].name == TORQUE]
        anew = len({entry["conditions"]["assembly"] for entry in entries}) > 1
        where = ", the wave generator fitted anew between them" if anew else ""
        compared = compare([[w[k] for w in watched if w] for k in range(len(found))])
        for one in compared:
            yield true_minus(f"sentinels{where}: {one.sentence}")
        if compared and anew_found:
            yield NOT_COMPARED


def _finds_torque(entry: Mapping[str, Any]) -> bool:
    """Whether each sentinel finds the torque that holds its speed, none being given."""
    return entry["procedure"].replace("-", "_") in FINDING and not entry["parameters"].get("torque")


def _as_found(e: Estimate) -> Estimate:
    """A torque with the interval of how well it was found: that of what was then given says nothing of friction."""
    half = math.hypot((e.ci95[1] - e.ci95[0]) / 2, Z95 * FOUND * e.value)
    return replace(e, ci95=(e.value - half, e.value + half))


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
