"""Plans of a few lines."""

from __future__ import annotations

from rig.bench import Bench, read
from rig.campaign.plan import Plan, parse_plan
from rig.campaign.planner import Campaign, planned

HEAD = 'schema = "hdrig.plan/1"\nname = "small"\n'
REST = '\n[[step]]\nprocedure = "standstill"\nwith = { duration = 0.2 }\n'
LOCKED = '\n[[step]]\nprocedure = "lock-check"\n'
LOADED = REST + "weight = 2.0\n"


def plan(*parts: str, head: str = HEAD) -> Plan:
    return parse_plan(head + "".join(parts), "small.toml")


def campaign(*parts: str, seed: int = 1, head: str = HEAD, bench: Bench | None = None) -> Campaign:
    return planned(plan(*parts, head=head), bench or read("twin"), seed)


def turning(speed_rpm: float, *more: str) -> str:
    return f'\n[[step]]\nprocedure = "constant-torque"\nwith = {{ speed_rpm = {speed_rpm} }}\n' + "\n".join(more) + "\n"
