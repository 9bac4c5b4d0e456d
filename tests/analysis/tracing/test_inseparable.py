"""What no channel tells apart is said to be ambiguous, whatever the numbers prefer."""

from __future__ import annotations

import pytest

from rig.analysis.tracing.answer import Status, Verdict
from rig.analysis.tracing.selection.conclusion import Conclusion
from rig.analysis.tracing.selection.inseparable import inseparable, whose_spring, winds_up
from rig.analysis.tracing.selection.sentences import HOUSING, SPRING, lacks

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


def said_of(*names: str) -> Conclusion:
    return Conclusion(Verdict(Status.EXPLAINED, names, (), None, None, None, lacks(names, 2.6, 1.0)), None, (), None)


@pytest.mark.parametrize("names", [(SPRING, HOUSING), (HOUSING, SPRING), (HOUSING, WEIGHT, SPRING)])
def test_beside_a_housing_nobody_knows_whose_spring_is_not_linear(names: tuple[str, ...]) -> None:
    verdict = whose_spring(said_of(*names)).verdict
    assert verdict.effects == tuple(name for name in names if name != SPRING)
    assert "nonlinear stiffness" not in verdict.sentence
    assert "(the housing moves)" in verdict.sentence
    assert " and a spring that is not linear (the gear's, or the housing's mount: no channel" in verdict.sentence
    assert "): with them the worst" in verdict.sentence


@pytest.mark.parametrize("names", [(SPRING,), (HOUSING,), (SPRING, WEIGHT), ()])
def test_of_one_spring_it_is_known(names: tuple[str, ...]) -> None:
    said = said_of(*(names or (WEIGHT,)))
    assert whose_spring(said) is said


def test_what_a_weight_may_wind_up_is_no_runout_beside_a_rest_that_goes_with_the_same_angle() -> None:
    """As of a joint of an arm whose torque nobody read (LARA8, joint 3)."""
    names, angles = ("output_once_per_rev", "cogging_torque"), {"theta_m", "theta_l", "tau_m"}
    assert winds_up(names, "load_angle", angles) == ("cogging_torque",)
    assert winds_up(names, "speed", angles) == names
    assert winds_up(names, "speed", angles - {"tau_m"}) == ("cogging_torque",)
    assert winds_up(names, "load_angle", angles | {"tau_l"}) == names
