"""The catalogue of sweeps: name on the command line → "module:class". A sweep is many runs of one procedure."""

from __future__ import annotations

import importlib
from abc import ABC, abstractmethod
from typing import cast

from rig.campaign.plan import StepSection

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
