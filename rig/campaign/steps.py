"""From the sections of a plan to single runs: parameters checked, sweeps unfolded, each with the rigging it needs."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, Literal

from rig.campaign.plan import PlanFile, StepSection
from rig.campaign.sweeps import CATALOGUE as SWEEPS
from rig.campaign.sweeps import sweep_class
from rig.core.errors import UsageError
from rig.core.nearest import nearest
from rig.core.operator import Rigging
from rig.core.procedure import Procedure
from rig.parameters.read import make
from rig.procedures import CATALOGUE as PROCEDURES
from rig.procedures import procedure_class

Kind = Literal["warm-up", "sentinel", "step"]


@dataclass(frozen=True)
class Item:
    """One run of a campaign."""

    kind: Kind
    title: str  # of the procedure, as on the command line
    procedure: Procedure
    parameters: dict[str, Any]  # as the plan gives them
    rigging: Rigging  # what the rig must be like
    repeat: int = 1
    of: int = 1
    allow_resonance: bool = False
    note: str = ""
    way: Literal["up", "down"] | None = None  # of a sweep that goes both ways

    def words(self) -> str:
        """How a person calls it: 'constant-torque speed_rpm=300, 2 of 2, 5 N·m'."""
        given = " ".join(f"{name}={value:g}" if isinstance(value, float) else f"{name}={value}"
                         for name, value in self.parameters.items())  # fmt: skip
        extra = [f"{self.repeat} of {self.of}"] if self.of > 1 else []
        kind = "" if self.kind == "step" or self.kind == self.title else f"{self.kind}: "
        return ", ".join([f"{kind}{self.title} {given}".strip(), *extra, *rigging_words(self.rigging)])

    def record(self) -> dict[str, Any]:
        """For campaign.json: what was planned."""
        return {
            "kind": self.kind, "procedure": self.title, "parameters": self.parameters,
            "conditions": self.rigging.conditions(), "repeat": self.repeat, "of": self.of, "note": self.note,
        }  # fmt: skip


def rigging_words(rigging: Rigging) -> list[str]:
    """What differs from a free, unloaded output in its first assembly."""
    words = []
    if rigging.tau_ext:
        words.append(f"{rigging.tau_ext:+g} N·m")
    if rigging.output_locked:
        words.append("locked")
    if rigging.assembly > 1 or rigging.depth_mm:
        words.append(f"assembly {rigging.assembly} at {rigging.depth_mm:+g} mm")
    return words


def items_of(plan: PlanFile, source: str) -> list[Item]:
    """Every run of the plan's steps, in the order written; warm-up and sentinels are put in by `rig.campaign.order`.

    Raises UsageError naming `source`: no such procedure or parameter, a weight on a locked output.
    """
    found: list[Item] = []
    rigging = Rigging()
    for number, section in enumerate(plan.step, 1):
        where = f"{source}, step {number}"
        for repeat in range(1, section.repeats + 1):
            for single in _unfold(section, where):
                anew = single.reassemble and (repeat == 1 or single is not section)
                rigging = _required(rigging, single, reassemble=anew)
                found.append(_item("step", single, rigging, where, repeat, section.repeats))
    return found


def extra_items(kind: Kind, section: StepSection, source: str) -> list[Item]:
    """The warm-up or the sentinel, as often as it is repeated in one place. Raises UsageError."""
    where, rigging = f"{source}, {kind}", Rigging(tau_ext=section.weight)
    return [_item(kind, section, rigging, where, k, section.repeats) for k in range(1, section.repeats + 1)]


def _unfold(section: StepSection, where: str) -> Iterable[StepSection]:
    """A sweep as the steps it stands for, a procedure as itself."""
    if section.procedure not in SWEEPS:
        return [section]
    try:
        sweep = make(sweep_class(section.procedure), section.parameters, section.procedure)
    except UsageError as error:
        raise UsageError(f"{where}: {error}") from None
    if section.weight or section.depth_mm is not None:
        raise UsageError(f"{where}: {section.procedure} sets weight and depth itself; give them in its 'with'")
    return sweep.sections()


def _required(before: Rigging, section: StepSection, reassemble: bool) -> Rigging:
    """What the rig must be like; without a depth of its own a step is made in the assembly of the one before."""
    depth = before.depth_mm if section.depth_mm is None else section.depth_mm
    fitted = before.assembly + (1 if reassemble or depth != before.depth_mm else 0)
    return Rigging(section.weight, False, depth, fitted)


def _item(kind: Kind, section: StepSection, rigging: Rigging, where: str, repeat: int, of: int) -> Item:
    name = section.procedure.replace("_", "-")
    if name not in PROCEDURES:
        known = [*PROCEDURES, *SWEEPS]
        raise UsageError(f"{where}: no procedure called '{section.procedure}'; {nearest(name, known)}")
    try:
        procedure = make(procedure_class(name), section.parameters, name)
    except UsageError as error:
        raise UsageError(f"{where}: {error}") from None
    if procedure.output_locked and section.weight:
        raise UsageError(
            f"{where}: {name} needs a locked output, and {section.weight:+g} N·m would hang on the lock pin; "
            "expected weight = 0"
        )
    return Item(
        kind, name, procedure, section.parameters, replace(rigging, output_locked=procedure.output_locked),
        repeat, of, section.allow_resonance, section.note, section.way,
    )  # fmt: skip
