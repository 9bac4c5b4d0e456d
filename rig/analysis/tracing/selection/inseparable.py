"""Effects that no channel of a campaign can tell apart, whatever the numbers say."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import Final

from rig.analysis.tracing.selection.conclusion import Conclusion
from rig.analysis.tracing.selection.sentences import HOUSING, SPRING

TORQUES: Final = frozenset({"tau_m", "tau_l"})
WIND_UP: Final = frozenset({"theta_m", "theta_l"})
RUNOUT, WEIGHT, CROSSTALK = "output_once_per_rev", "gravity_unbalance", "torque_sensor_crosstalk"


def inseparable(names: Collection[str], has: Collection[str]) -> tuple[str, ...]:
    """Rivals of `names` where `has` are the channels. In angles alone a weight that winds the gear up once an output
    turn is a runout, and either torque feels it. In the shaft torque alone it is the sensor's own crosstalk: the
    wind-up feels it, and the motor's torque."""
    known = set(has)
    rivals = {WEIGHT} if RUNOUT in names and not TORQUES & known else set()
    if "tau_m" not in known and not known >= WIND_UP:
        rivals |= {other for one, other in ((WEIGHT, CROSSTALK), (CROSSTALK, WEIGHT)) if one in names}
    return tuple(sorted(rivals - set(names)))


def winds_up(names: Sequence[str], coordinate: str, has: Collection[str]) -> tuple[str, ...]:
    """`names` that stand beside a rest of that `coordinate`. Where nobody read the shaft torque, a weight may be behind
    both if the rest goes with the output's angle, or no torque was read at all: what it winds up is a wave in that
    angle, and no runout."""
    if "tau_l" not in has and (coordinate == "load_angle" or "tau_m" not in has):
        return tuple(name for name in names if name != RUNOUT)
    return tuple(names)


def whose_spring(said: Conclusion) -> Conclusion:
    """Of a housing that gives way, with a spring that is not linear: its mount may be that spring, and the gear then
    has none such (exam 63, case 20; 65, 19). Its sentence says so."""
    verdict = said.verdict
    if not {HOUSING, SPRING} <= set(verdict.effects):
        return said
    named = tuple(name for name in verdict.effects if name != SPRING)
    return replace(said, verdict=replace(verdict, effects=named))
