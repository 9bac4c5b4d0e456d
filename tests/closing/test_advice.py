"""What a trace asks for becomes runs of this rig, or is refused in words."""

import pytest

from rig.analysis.tracing.answer import NextRun
from rig.bench import read
from rig.campaign.plan import parse_plan
from rig.campaign.planner import Campaign, planned
from rig.closing.advice import advised, from_text, same
from rig.core.errors import NotReady, UsageError

PLAN = """schema = "hdrig.plan/1"
name = "small"
[[step]]
procedure = "kinematic-error"
with = { amplitude_deg = 90, frequency = 0.16, cycles = 1 }
depth_mm = 0.1
"""


@pytest.fixture
def campaign() -> Campaign:
    return planned(parse_plan(PLAN, "small.toml"), read("twin"), 1)


def test_a_run_is_asked_for_twice_in_the_assembly_the_rig_is_in(campaign: Campaign) -> None:
    advice = advised(NextRun("constant_torque", {"speed_rpm": 400.0}, "why"), campaign)
    assert [item.title for item in advice.items] == ["constant-torque"] * 2
    assert {item.rigging.assembly for item in advice.items} == {campaign.items[0].rigging.assembly} == {2}
    assert {item.rigging.depth_mm for item in advice.items} == {0.1}


def test_a_weight_among_the_conditions_is_hung_by_hand_and_its_checks_take_time(campaign: Campaign) -> None:
    slow = {"amplitude_deg": 90.0, "frequency": 0.16, "cycles": 1.0}
    bare = advised(NextRun("kinematic_error", {**slow}, "why"), campaign)
    loaded = advised(NextRun("kinematic_error", {**slow, "tau_ext": -5.0}, "why"), campaign)
    assert loaded.items[0].rigging.tau_ext == -5.0
    assert loaded.rig_time > bare.rig_time + 10.0  # s: weighed when hung, and when taken off


def test_a_lock_test_without_an_amplitude_is_made_at_two(campaign: Campaign) -> None:
    advice = advised(NextRun("stiffness_lock", {"output_locked": True}, "nested amplitudes"), campaign)
    assert [item.parameters["tau_max"] for item in advice.items] == [5.0, 5.0, 20.0, 20.0]
    assert all(item.rigging.output_locked for item in advice.items)


def test_what_was_written_down_gives_the_same_runs_again(campaign: Campaign) -> None:
    advice = advised(NextRun("sentinel", {"speed_rpm": 120.0}, "why"), campaign)
    assert from_text(advice.text, campaign) == advice


def test_a_run_beyond_a_limit_of_the_bench_is_refused_with_the_limit(campaign: Campaign) -> None:
    with pytest.raises(NotReady, match="allows 600"):
        advised(NextRun("constant_torque", {"speed_rpm": 900.0}, "why"), campaign)


def test_a_procedure_hdrig_does_not_have_is_refused_by_name(campaign: Campaign) -> None:
    with pytest.raises(UsageError, match="temperature_step"):
        advised(NextRun("temperature_step", {}, "why"), campaign)


def test_a_condition_the_procedure_does_not_know_is_refused_by_name(campaign: Campaign) -> None:
    with pytest.raises(UsageError, match="humidity"):
        advised(NextRun("sentinel", {"humidity": 0.4}, "why"), campaign)


def test_the_same_wish_again_is_seen() -> None:
    wish = NextRun("sentinel", {"speed_rpm": 120.0}, "for one reason")
    assert same(wish, {"procedure": "sentinel", "conditions": {"speed_rpm": 120.0}, "because": "for another"})
    assert not same(wish, {"procedure": "sentinel", "conditions": {"speed_rpm": 300.0}, "because": ""})
    assert not same(wish, None)
