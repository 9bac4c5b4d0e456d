"""Parameters as somebody types them: what is wrong with each, what the run would do, how far from every limit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rig.bench import Bench, read
from rig.campaign import dry_run
from rig.campaign.changes import deeds
from rig.campaign.clear_of_resonance import refuse_resonance, swing_lines
from rig.campaign.journal import read_journal, refuse_other_campaign
from rig.campaign.plan import read_plan
from rig.campaign.planner import Campaign, planned
from rig.campaign.preview import plan_lines, shaft_torque, stored_energy, tightest
from rig.campaign.sweeps import plan_named
from rig.console.bodies import OF_CHECK, misshapen, unknown
from rig.core.errors import HdrigError, NotReady, UsageError
from rig.core.operator import Rigging
from rig.core.procedure import Procedure
from rig.parameters.read import make
from rig.procedures import CATALOGUE, procedure_class
from rig.refusals import TOLD, margins, refuse_beyond_limits, refuse_endless
from rig.runfile.process import is_being_made

WHOLE = "*"  # the problem is of no single parameter
SEED = 0  # of the order of a plan that is only looked at


def check(asked: Mapping[str, Any], source: str, overrides: list[str]) -> dict[str, Any]:
    """For a procedure, a plan, or a campaign to go on with (`resume`, its folder), on the bench called `source`. Never
    raises for what a person could have typed.
    """
    mistyped = unknown("check-parameters", asked, OF_CHECK) or misshapen("check-parameters", asked)
    if mistyped:
        return wrong({WHOLE: mistyped})
    try:
        bench = read(source, overrides)
        if asked.get("resume"):
            return _resumed(bench, Path(str(asked["resume"])))
        if asked.get("plan"):
            return _plan(bench, str(asked["plan"]), asked.get("parameters") or {})
        return _procedure(bench, str(asked.get("procedure", "")), asked.get("parameters") or {})
    except HdrigError as error:
        return wrong({WHOLE: str(error)})


def unread(source: str, overrides: list[str]) -> str:
    """Why no bench is made of `source`; "" where one is."""
    try:
        read(source, overrides)
    except HdrigError as error:
        return str(error)
    return ""


def wrong(problems: dict[str, str]) -> dict[str, Any]:
    """By parameter; "*" for the whole."""
    return {"ok": False, "problems": problems, "plan": [], "margins": [], "sums": None}


def _plan(bench: Bench, name: str, parameters: Mapping[str, Any]) -> dict[str, Any]:
    if not isinstance(parameters, dict):
        raise UsageError("parameters: expected a table of names and values")
    campaign = planned(plan_named(name, parameters), bench, SEED)
    return _told(campaign, range(len(campaign.items)))


def _told(campaign: Campaign, runs: Sequence[int]) -> dict[str, Any]:
    """The dry run of those numbered `runs`, with the most that any of them asks for."""
    bench, items = campaign.bench, [campaign.items[k] for k in runs]
    found = [dry_run.figures(campaign, item) for item in items]
    asked = dry_run.asked_of(bench, found)
    left = {what: 1 - most / limit for what, most, limit, _ in asked if what != "torque"}
    nearest = min(left, key=lambda what: left[what])
    duration = sum(dry_run.lasting(campaign, list(deeds(list(zip(runs, items, strict=True)), Rigging()))))
    return {
        "ok": True, "problems": {}, "plan": list(dry_run.lines(campaign, runs)),
        "margins": [_margin(what, most, limit, unit) for what, most, limit, unit in asked],
        "sums": _sums(duration, max(f.energy for f in found), TOLD[nearest], left[nearest]),
    }  # fmt: skip


def _margin(what: str, asked: float, limit: float, unit: str) -> dict[str, Any]:
    clamped = what == "torque"  # the loop is held there: what a run will need is known only once it runs
    fraction = asked / limit if limit else 1.0
    return {"what": what, "asked": asked, "limit": limit, "unit": unit, "fraction": fraction, "clamped": clamped}


def _sums(duration: float, stored: float, nearest: str, left: float) -> dict[str, Any]:
    """What stands beside the margins: s and J at most, which limit is nearest and the share of it that is left."""
    return {"duration_s": duration, "stored_j": stored, "nearest": nearest, "left": left}


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
    return _told(campaign, left)


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
        _margin(what, asked * scale, limit * scale, unit)
        for what, asked, limit, unit, scale in margins(bench, procedure)
    ]
    sums = _sums(
        procedure.envelope(bench.setting(lambda text: None)).duration,
        stored_energy(bench, procedure, shaft_torque(bench, procedure)),
        *tightest(bench, procedure),
    )
    lines = [*plan_lines(bench, procedure), *swing_lines(bench, procedure)]
    try:
        refuse_beyond_limits(bench, procedure)
        refuse_resonance(bench, procedure)
    except HdrigError as error:
        return {"ok": False, "problems": {WHOLE: str(error)}, "plan": lines, "margins": shown, "sums": sums}
    return {"ok": True, "problems": {}, "plan": lines, "margins": shown, "sums": sums}
