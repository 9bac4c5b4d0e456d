"""What a trace asks for, as runs this rig can make; what it cannot make is refused in words, before anything moves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, Final

import tomlkit

from rig.analysis.tracing.answer import NextRun
from rig.campaign.changes import ByHand, deeds
from rig.campaign.dry_run import checks_of
from rig.campaign.plan import Plan, parse_plan
from rig.campaign.planner import Campaign, planned
from rig.campaign.steps import Item
from rig.campaign.sweeps import CATALOGUE as SWEEPS
from rig.core.errors import UsageError
from rig.core.operator import Rigging
from rig.procedures import CATALOGUE as PROCEDURES
from rig.procedures import procedure_class

TWICE: Final = 2  # every run: the floor is what two of a kind differ by
OTHER_NAMES: Final = {"constant-speed": "constant-torque"}  # what other rigs call it
OF_THE_RIG: Final = ("output_locked", "assembly", "note", "settle_s")  # conditions that are no wish of their own
LOCK_STEPS: Final = (5.0, 20.0)  # N·m: nested amplitudes, one within what soft wind-up and gaps fill, one far beyond
ONCE: Final = (1.0,)  # of the lock test's usual rate: it sticks and slips, and every stay is one reading


@dataclass(frozen=True)
class Advice:
    """One round's runs. `rig_time` is what they take with their checks [s], `text` the plan they make."""

    items: tuple[Item, ...]
    rig_time: float
    text: str

    @property
    def words(self) -> str:
        """For the person."""
        return "; ".join(item.words() for item in self.items)


def sections(asked: NextRun) -> list[dict[str, Any]]:
    """Steps of a plan. Raises UsageError when hdrig has no such procedure, or it has no such condition."""
    name = asked.procedure.replace("_", "-")
    name = OTHER_NAMES.get(name, name)
    if name not in PROCEDURES and name not in SWEEPS:
        raise UsageError(f"the trace asks for '{asked.procedure}', which this hdrig cannot run")
    if name in SWEEPS:
        return [{"procedure": name, "with": {k: v for k, v in asked.conditions.items() if k not in OF_THE_RIG}}]
    wanted = {k: v for k, v in asked.conditions.items() if k not in OF_THE_RIG}
    step: dict[str, Any] = {"procedure": name, "repeats": TWICE}
    for condition, key in (("tau_ext", "weight"), ("depth_mm", "depth_mm")):
        if wanted.get(condition):
            step[key] = wanted[condition]
        wanted.pop(condition, None)
    known = [f.name for f in fields(procedure_class(name))]  # type: ignore[arg-type]
    odd = [k for k in wanted if k not in known]
    if odd:
        raise UsageError(f"the trace asks for {name} with {odd[0]} = {wanted[odd[0]]}, which {name} does not know")
    if name == "stiffness-lock" and "tau_max" not in wanted:
        return [step | {"with": {"tau_max": tau, "cycles": 1, "rates": list(ONCE)} | wanted} for tau in LOCK_STEPS]
    return [step | {"with": wanted}]


def plan_for(steps: list[dict[str, Any]], of: Plan) -> Plan:
    """A plan of those steps alone, as told in the campaign's folder."""
    text = tomlkit.dumps({"schema": "hdrig.plan/1", "name": "advised", "step": steps})
    return parse_plan(text, f"{Path(of.source).name}, advised")


def advised(asked: NextRun, campaign: Campaign) -> Advice:
    """The runs asked for, after those of `campaign`, in its last assembly.

    Raises UsageError and NotReady with the reason in words: no such run, or beyond a limit of the bench.
    """
    return from_text(plan_for(sections(asked), campaign.plan).text, campaign)


def from_text(text: str, campaign: Campaign) -> Advice:
    """The same from the plan written down when it was first asked for."""
    made = planned(parse_plan(text, "advised"), campaign.bench, campaign.seed)
    last = campaign.items[-1].rigging
    items = tuple(_in_assembly(item, last) for item in made.items)
    return Advice(items, duration(campaign, items), text)


def _in_assembly(item: Item, last: Rigging) -> Item:
    r = item.rigging
    if r.depth_mm or r.assembly != 1:  # it asks for an assembly of its own: one later than what there was
        return replace(item, rigging=replace(r, assembly=last.assembly + r.assembly - 1))
    return replace(item, rigging=replace(r, depth_mm=last.depth_mm, assembly=last.assembly))


def duration(campaign: Campaign, items: tuple[Item, ...]) -> float:
    """s of rig time those runs and the checks of their changes take at most, from a bare rig."""
    begin = Rigging(0.0, False, campaign.items[-1].rigging.depth_mm, campaign.items[-1].rigging.assembly)
    todo = deeds(list(enumerate(items)), begin)
    checks = [check for deed in todo if isinstance(deed, ByHand) for check in checks_of(deed.change)]
    setting = campaign.bench.setting(lambda text: None)
    return sum(campaign.envelope(i).duration for i in items) + sum(c.envelope(setting).duration for c in checks)


def same(a: NextRun | None, b: Mapping[str, Any] | None) -> bool:
    """Whether a trace asks for what was asked for before."""
    return a is not None and b is not None and (a.procedure, dict(a.conditions)) == (b["procedure"], b["conditions"])
