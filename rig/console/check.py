"""Parameters as somebody types them: what is wrong with each, what the run would do, how far from every limit."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rig.bench import Bench, read
from rig.campaign import dry_run
from rig.campaign.clear_of_resonance import refuse_resonance, swing_lines
from rig.campaign.journal import read_journal, refuse_other_campaign
from rig.campaign.plan import read_plan
from rig.campaign.planner import planned
from rig.core.errors import HdrigError, NotReady, UsageError
from rig.core.procedure import Procedure
from rig.parameters import make
from rig.preview import plan_lines
from rig.procedures import CATALOGUE, procedure_class
from rig.refusals import margins, refuse_beyond_limits, refuse_endless
from rig.runfile.process import is_being_made

WHOLE = "*"  # the problem is of no single parameter
SEED = 0  # of the order of a plan that is only looked at


def check(asked: Mapping[str, Any], source: str, overrides: list[str]) -> dict[str, Any]:
    """For a procedure, a plan, or a campaign to go on with (`resume`, its folder), on the bench called `source`. Never
    raises for what a person could have typed.
    """
    try:
        bench = read(source, overrides)
        if asked.get("resume"):
            return _resumed(bench, Path(str(asked["resume"])))
        if asked.get("plan"):
            return _plan(bench, str(asked["plan"]))
        return _procedure(bench, str(asked.get("procedure", "")), asked.get("parameters") or {})
    except HdrigError as error:
        return wrong({WHOLE: str(error)})


def wrong(problems: dict[str, str]) -> dict[str, Any]:
    """By parameter; "*" for the whole."""
    return {"ok": False, "problems": problems, "plan": [], "margins": []}


def _plan(bench: Bench, name: str) -> dict[str, Any]:
    campaign = planned(read_plan(name), bench, SEED)
    return {"ok": True, "problems": {}, "plan": list(dry_run.lines(campaign)), "margins": []}


def _resumed(bench: Bench, folder: Path) -> dict[str, Any]:
    """What is left of it, on the bench that is connected: that has to be the one it began with."""
    journal = read_journal(folder)
    if is_being_made(journal.book):
        raise NotReady(f"{folder} is being made by process {journal.book['process']['pid']}; stop that first")
    campaign = planned(read_plan(str(folder / "plan.toml")), bench, journal.book["seed"])
    refuse_other_campaign(journal, campaign)
    left = journal.open_runs()
    if not left:
        raise UsageError(f"nothing is left to be made of {folder}")
    return {"ok": True, "problems": {}, "plan": list(dry_run.lines(campaign, left)), "margins": []}


def _procedure(bench: Bench, title: str, parameters: Mapping[str, Any]) -> dict[str, Any]:
    name = title.replace("_", "-")
    if name not in CATALOGUE:
        raise UsageError(f"no procedure called '{title[:60]}'; expected one of {', '.join(CATALOGUE)}")
    kind = procedure_class(name)
    if not isinstance(parameters, dict):
        raise UsageError("parameters: expected a table of names and values")
    problems = {}
    for parameter, value in parameters.items():
        try:
            make(kind, {parameter: value}, name)
        except HdrigError as error:
            problems[str(parameter)] = str(error)
    if problems:
        return wrong(problems)
    procedure: Procedure = make(kind, parameters, name)  # what no single one shows is said of the whole
    return _looked_at(bench, procedure)


def _looked_at(bench: Bench, procedure: Procedure) -> dict[str, Any]:
    refuse_endless(bench, procedure)
    shown = [
        {
            "what": what,
            "asked": asked * scale,
            "limit": limit * scale,
            "unit": unit,
            "fraction": asked / limit if limit else 1.0,
            "clamped": what == "torque",  # the loop is held there: what a run will need is known only once it runs
        }
        for what, asked, limit, unit, scale in margins(bench, procedure)
    ]
    lines = [*plan_lines(bench, procedure), *swing_lines(bench, procedure)]
    try:
        refuse_beyond_limits(bench, procedure)
        refuse_resonance(bench, procedure)
    except HdrigError as error:
        return {"ok": False, "problems": {WHOLE: str(error)}, "plan": lines, "margins": shown}
    return {"ok": True, "problems": {}, "plan": lines, "margins": shown}
