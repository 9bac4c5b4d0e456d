"""Which names stand beside a rest that no effect explains."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.selection.beside_a_law import beside_a_law, beside_little, confounded, larger_than
from rig.analysis.tracing.selection.confounders import CONFOUNDERS
from rig.analysis.tracing.selection.falls import share, share_of_all
from rig.analysis.tracing.selection.score import HeldOutScore
from rig.analysis.tracing.selection.standing import standing
from rig.analysis.tracing.selection.verdict import _along_the_same_turn as along_the_same_turn
from rig.analysis.tracing.selection.verdict import _of_the_same_order as of_the_same_order
from rig.analysis.tracing.selection.verdict import is_next_to_nothing
from rig.analysis.tracing.thresholds import PART
from rig.model.effects.nonlinear_stiffness import NonlinearStiffness
from rig.model.effects.torque_ripple import TorqueRipple

CLEAN = HeldOutScore("cogging_torque", 0.7, 3.0, 1.1, 1.0, (), anywhere=1.1)
PLAIN = HeldOutScore("hysteretic_stiffness", 0.9, 30.0, 6.0, 1.0, (), anywhere=6.0)
NEITHER = HeldOutScore("lost_motion", 0.7, 3.0, 2.0, 1.0, (), anywhere=2.0)
ALL = [CLEAN, PLAIN, NEITHER]


def named(coordinate: str, told: bool, *scores: HeldOutScore) -> tuple[str, ...]:
    return standing(
        coordinate, [score.name for score in scores], scores, {score.name for score in scores if score.plain}, told
    )


def test_what_is_plain_to_see_stands_and_what_leaves_nothing_where_it_acts() -> None:
    assert named("load", True, *ALL) == ("cogging_torque", "hysteretic_stiffness")


def test_where_no_floor_is_known_only_what_is_plain_stands() -> None:
    assert named("load", False, *ALL) == ("hysteretic_stiffness",)


def test_where_no_floor_is_known_what_is_large_and_all_there_is_stands_beside_a_rest_in_other_channels() -> None:
    sure = HeldOutScore("load_dependent_friction", 1.0, 11.8, 0.95, 1.0, (), anywhere=0.96, runs=1)
    assert named("load", False, sure) == ("load_dependent_friction",)
    assert named("load", False, replace(sure, size=4.0)) == ()
    assert named("load", False, replace(sure, anywhere=1.6)) == ()
    assert named("load", False, replace(sure, share=0.9)) == ()


def test_beside_a_memory_a_loop_stands_only_where_it_is_plain() -> None:
    small = replace(PLAIN, share=0.7, anywhere=1.1)
    assert named("memory", True, CLEAN, small) == ("cogging_torque",)
    assert named("memory", True, CLEAN, PLAIN) == ("cogging_torque", "hysteretic_stiffness")


def test_what_leaves_much_in_the_runs_it_acts_in_stands_only_where_it_is_plain() -> None:
    assert named("load", True, replace(CLEAN, left=2.2)) == ()
    assert named("load", True, PLAIN) == ("hysteretic_stiffness",)


def test_what_takes_next_to_nothing_of_the_channel_it_gains_most_in_is_no_part_of_it() -> None:
    assert share(4.34, 4.28) < PART < share(4.34, 3.6)  # a sensor's wobble, of which a spring took a thirtieth
    assert share(1.3, 1.0) == 1.0


@pytest.mark.parametrize(("left", "same"), [(19.0, {"torque_ripple"}), (18.0, set()), (None, set())])
def test_a_ripple_of_the_order_that_is_left_in_the_angle_is_no_ripple(left: float | None, same: set[str]) -> None:
    """A wave of the kinematic error that the series has no term for turns the inertia to and fro as well."""
    terms = (Term(TorqueRipple(), (19.0, 0.0)), Term(NonlinearStiffness(), (2.0, 19.0)))
    s: Any = SimpleNamespace(design=SimpleNamespace(terms=terms))
    assert of_the_same_order(s, Home("motor_angle", "A", 0.9, order=left)) == same
    assert of_the_same_order(s, Home("load_angle", "A", 0.9, order=left)) == set()


def test_a_step_along_the_outputs_turn_is_no_runout_though_a_few_orders_draw_it() -> None:
    assert along_the_same_turn(Home("load_angle", "A", 0.9)) == {"output_once_per_rev"}
    assert along_the_same_turn(Home("load_angle", "L", 0.9)) == {"torque_sensor_crosstalk"}
    for other in (Home("load_angle", "M", 0.9), Home("load_angle", "A", 0.9, order=7.0), Home("motor_angle", "A", 0.9)):
        assert along_the_same_turn(other) == set()


def test_what_explains_one_channel_beside_far_more_in_others_takes_little_of_all() -> None:
    keys = [(0, c) for c in "AML"]
    p: Any = SimpleNamespace(held_out=SimpleNamespace(ratio=lambda ratios, mine: ratios[mine[0]]))
    before: Any = dict(zip(keys, (1.2, 1.26, 1.6), strict=True))
    one: Any = before | {(0, "A"): 1.0}
    assert share(1.2, 1.0) > 0.9
    assert share_of_all(p.held_out, before, one) == pytest.approx(0.44 / (0.44 + 0.5876 + 1.56))
    assert share_of_all(p.held_out, before, dict.fromkeys(keys, 1.0)) == pytest.approx(1.0)


def test_a_torque_in_one_way_only_is_no_weight_beside_a_friction() -> None:
    named = confounded(CONFOUNDERS["sector_drag"], ("cogging_torque", "gravity_unbalance"))
    assert named.verdict.effects == ("cogging_torque",)
    other = confounded(CONFOUNDERS["oval_pulley"], ("gravity_unbalance",))
    assert other.verdict.effects == ("gravity_unbalance",)


@pytest.mark.parametrize(("own", "stand"), [
    (("external_vibration",), ("external_vibration", "hysteretic_stiffness")), ((), ("hysteretic_stiffness",)),
])  # fmt: skip
def test_a_vibration_of_all_runs_stands_beside_a_law_that_leaves_nothing(
    own: tuple[str, ...], stand: tuple[str, ...]
) -> None:
    """It has no score on unseen runs, for every run has its own phase of it."""
    names = ("external_vibration", CLEAN.name, PLAIN.name)
    assert beside_a_law("load", names, [CLEAN, PLAIN], {PLAIN.name}, own) == stand


@pytest.mark.parametrize(("drift", "larger"), [
    (0.9, {"hysteretic_stiffness", "cogging_torque"}), (1.2, set()),
])  # fmt: skip
def test_names_stand_beside_a_law_that_is_below_the_floor(drift: float, larger: set[str]) -> None:
    """The gain of a torque sensor that drifts by a little beside a loop of thirty floors."""
    law = HeldOutScore("sensor_gain_drift", 0.9, drift, 1.1, 1.0, (), anywhere=1.1)
    laws, names = [CONFOUNDERS["sensor_gain_drift"]], (PLAIN.name, CLEAN.name, "quadratic_drag")
    smaller = HeldOutScore("quadratic_drag", 0.9, 0.8, 1.0, 1.0, (), anywhere=1.0)
    scores = [PLAIN, replace(CLEAN, size=1.3), smaller, law]
    assert set(larger_than(laws, names, scores, {PLAIN.name})) == larger
    assert larger_than(laws, names, scores, {PLAIN.name, law.name}) == ()  # it is plain to see
    assert larger_than(laws, names, scores, set()) == ()  # no name is


def test_the_sentence_says_that_there_is_a_law_beside_the_names() -> None:
    found = confounded(CONFOUNDERS["sensor_gain_drift"], ("hysteretic_stiffness",))
    said = beside_little(CONFOUNDERS["sensor_gain_drift"], found).verdict
    assert said.effects == ("hysteretic_stiffness",)
    assert said.sentence.startswith(found.verdict.sentence)
    assert "less than the floor in any run" in said.sentence


@pytest.mark.parametrize(("total", "share", "nothing"), [(1.33, 0.27, True), (1.33, 0.5, False), (1.6, 0.1, False)])
def test_a_little_that_no_coordinate_foretells_is_no_effect(total: float, share: float, nothing: bool) -> None:
    assert is_next_to_nothing(Home("memory", "M", share), total) == nothing
