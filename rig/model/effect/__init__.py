"""What an effect is: where it acts on the rig, and the columns it adds to the equations there.

One definition serves the search for effects in measured runs, the refit, the simulation and the report.

| module | one idea |
|---|---|
| effect | `Effect`: columns, shapes, plausible signs |
| port | `Port`: where an effect enters |
| signals | `Signals`: what it sees of a run |
| known | `Known`: the baseline its columns may lean on |
| reach | `Reach`: what a campaign can show |
| fit | `Fit`: what the data say of it, and the figures made of that |
"""

from rig.model.effect.effect import Effect
from rig.model.effect.fit import Fit, Parameter, Shape, harmonic, parameter
from rig.model.effect.known import Known
from rig.model.effect.port import Port
from rig.model.effect.reach import MEASURED, Reach
from rig.model.effect.signals import Array, Moved, Signals

__all__ = [
    "MEASURED",
    "Array",
    "Effect",
    "Fit",
    "Known",
    "Moved",
    "Parameter",
    "Port",
    "Reach",
    "Shape",
    "Signals",
    "harmonic",
    "parameter",
]
