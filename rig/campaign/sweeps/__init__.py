"""The catalogue of sweeps: name on the command line → "module:class". A sweep is many runs of one procedure."""

from __future__ import annotations

import importlib
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, cast

from rig.campaign.plan import PLANS, Plan, StepSection, plan_of, read_plan
from rig.parameters.read import make

CATALOGUE: dict[str, str] = {
    "load-sweep": "rig.campaign.sweeps.load_sweep:LoadSweep",
    "assembly-sweep": "rig.campaign.sweeps.assembly_sweep:AssemblySweep",
    "identify": "rig.campaign.sweeps.identify:Identify",
}


class Sweep(ABC):
    """Parameters in the fields; every run of it is a run folder of its own."""

    @abstractmethod
    def sections(self) -> list[StepSection]:
        """The steps it stands for, in the order they are to be made."""


def sweep_class(name: str) -> type[Sweep]:
    """The sweep called `name` on the command line. KeyError when there is none."""
    module, _, member = CATALOGUE[name].partition(":")
    return cast(type[Sweep], getattr(importlib.import_module(module), member))


def plan_named(name: str, parameters: Mapping[str, Any]) -> Plan:
    """A plan by file or by the name of one that ships, or the plan of the sweep called `name`. Raises UsageError."""
    if name in CATALOGUE and not (PLANS / f"{name}.toml").is_file():
        make(sweep_class(name), parameters, name)  # what is wrong is said of the sweep, not of a plan nobody wrote
        return plan_of(name, parameters)
    return read_plan(name)
