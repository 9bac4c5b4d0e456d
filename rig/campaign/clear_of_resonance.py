"""A single run stays clear of the speed where order 2 meets the gear's torsional resonance, unless told otherwise."""

from __future__ import annotations

from rig.bench import Bench
from rig.campaign.swing import ORDER_2, into_resonance, predicted
from rig.core.errors import NotReady
from rig.core.procedure import Procedure


def refuse_resonance(bench: Bench, procedure: Procedure) -> None:
    """Raises NotReady. Whoever means to go there says so, on the command line."""
    if procedure.output_locked:
        return
    if words := into_resonance(bench, procedure.envelope(bench.setting(lambda text: None)), ORDER_2):
        raise NotReady(f"{procedure.title()}: {words}, or `hdrig run … --allow-resonance`")


def swing_lines(bench: Bench, procedure: Procedure) -> list[str]:
    """For a dry run: what the kinematic error is expected to do to the shaft torque of a free output."""
    speed = _speed(bench, procedure)
    return [] if procedure.output_locked or speed == 0.0 else [predicted(bench, speed, ORDER_2)]


def _speed(bench: Bench, procedure: Procedure) -> float:
    return procedure.envelope(bench.setting(lambda text: None)).speed
