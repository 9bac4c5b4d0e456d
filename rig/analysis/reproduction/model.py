"""The gear of equations 6-8 identified from the campaign, by runs that its figures do not show."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rig.analysis.identify.fit import fit
from rig.analysis.identify.identified import Identified, identified
from rig.analysis.identify.recording import recording
from rig.core.errors import DataError
from rig.model.fourier import PAPER_ORDERS
from rig.model.gear import Gear
from rig.model.gearfile import MeasuredSeries, Parameter
from rig.runfile.run import Run

NEEDED = ("J_m", "J_l", "K")  # what the motion at speed hangs on


@dataclass(frozen=True)
class Model:
    """The gear, every parameter with its interval, and the names of the runs it was identified from."""

    gear: Gear
    parameters: Mapping[str, Parameter]
    series: MeasuredSeries
    runs: tuple[str, ...]
    held_out: bool  # none of them is one the model is compared with
    cannot: tuple[str, ...]


def identify_gear(apart: Sequence[Path], shown: Sequence[Path]) -> Model:
    """The gear from the runs `apart`; only where they lack inertias or stiffness also from those `shown`.

    Raises DataError when both together lack them.
    """
    if apart:
        found = _identified(apart)
        if all(name in found.parameters and found.parameters[name].origin == "measured" for name in NEEDED):
            return _model(found, apart, held_out=True)
    everything = [*apart, *shown]
    if not everything:
        raise DataError("no run to identify a gear from")
    return _model(_identified(everything), everything, held_out=False)


def _identified(folders: Sequence[Path]) -> Identified:
    runs = [Run.open(folder) for folder in folders]
    recordings = [r for run in runs if (r := recording(run)) is not None]
    if not recordings:
        raise DataError("no run here has time and both angles: nothing to identify from")
    return identified(fit(recordings, PAPER_ORDERS), runs[0].manifest)


def _model(found: Identified, folders: Sequence[Path], held_out: bool) -> Model:
    gear = found.gear_file("", simulated=False, made="").gear()
    names = tuple(folder.name for folder in folders)
    return Model(gear, found.parameters, found.series, names, held_out, found.cannot)
