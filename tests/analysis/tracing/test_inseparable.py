"""What no channel tells apart is said to be ambiguous, whatever the numbers prefer."""

from __future__ import annotations

import pytest

from rig.analysis.tracing.selection.inseparable import inseparable

RUNOUT, WEIGHT, CROSSTALK = "output_once_per_rev", "gravity_unbalance", "torque_sensor_crosstalk"


@pytest.mark.parametrize(
    ("names", "has", "rivals"),
    [
        ({RUNOUT}, {"theta_m", "theta_l"}, (WEIGHT,)),
        ({RUNOUT}, {"theta_m", "theta_l", "tau_m"}, ()),
        ({CROSSTALK}, {"theta_m", "tau_l"}, (WEIGHT,)),
        ({WEIGHT}, {"theta_l", "tau_l"}, (CROSSTALK,)),
        ({WEIGHT}, {"theta_m", "theta_l", "tau_l"}, ()),  # a weight winds the gear up
        ({WEIGHT}, {"theta_m", "tau_l", "tau_m"}, ()),  # and the motor has to hold it
        ({WEIGHT, CROSSTALK}, {"theta_m", "tau_l"}, ()),
        ({"stribeck_friction"}, {"theta_m", "tau_l"}, ()),
    ],
)
def test_the_channels_there_are_decide(names: set[str], has: set[str], rivals: tuple[str, ...]) -> None:
    assert inseparable(names, has) == rivals
