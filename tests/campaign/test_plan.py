"""A plan is read strictly: what cannot be meant is one sentence that names the place."""

from __future__ import annotations

from pathlib import Path

import pytest

from rig.bench import read
from rig.campaign.journal import new_journal, refuse_other_campaign
from rig.campaign.plan import PLANS, plan_of, read_plan
from rig.campaign.planner import planned
from rig.campaign.steps import items_of
from rig.commands.campaign import _plan_of
from rig.core.errors import UsageError
from rig.procedures.constant_torque import ConstantTorque
from tests.campaign.plans import HEAD, REST, plan


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (HEAD, ["'step' is missing"]),
        (HEAD + REST + "repeat = 2\n", ["unknown key 'step.1.repeat'", "did you mean 'repeats'"]),
        (HEAD + REST + "weight = { value = 3, unit = 'kg' }\n", ["3 kg", "expected the unit N·m"]),
        (HEAD + REST + "repeats = 0\n", ["step.1.repeats = 0", "greater than or equal to 1"]),
        (HEAD + "order = 'shuffled'\n" + REST, ["order = 'shuffled'", "random"]),
        (HEAD + "[sentinel]\nat = ['noon']\n" + REST, ["noon", "start"]),
        (HEAD + REST + REST + "weight = '3 N'\n", ["step.2.weight = '3 N'", "expected a number in N·m"]),
        (HEAD + "[sentinel]\nat = []\n" + REST, ["sentinel.at = []: expected a list of 1 or more"]),
        ("step = []\n" + HEAD, ["step = []: expected a list of 1 or more"]),
        (HEAD.replace("small", "../up") + REST, ["name", "../up"]),
        ("x = [", ["not valid TOML"]),
    ],
)
def test_what_cannot_be_meant_is_refused_with_key_and_value(text: str, words: list[str]) -> None:
    with pytest.raises(UsageError) as refused:
        plan(head=text)
    for word in ["small.toml", *words]:
        assert word in str(refused.value)


@pytest.mark.parametrize(
    ("step", "words"),
    [
        ('procedure = "standstil"', ["step 2", "no procedure called 'standstil'", "'standstill'"]),
        ('procedure = "standstill"\nwith = { durations = 1 }', ["step 2", "standstill has no parameter", "'duration'"]),
        ('procedure = "standstill"\nwith = { duration = "long" }', ["step 2", "duration = long", "a finite number"]),
        ('procedure = "standstill"\nwith = { duration = -1 }', ["step 2", "expected more than 0"]),
        ('procedure = "lock-check"\nweight = 3', ["step 2", "locked output", "+3 N·m"]),
        ('procedure = "load-sweep"\nweight = 3', ["step 2", "load-sweep sets weight and depth itself"]),
        ('procedure = "load-sweep"\nwith = { weights = "heavy" }', ["step 2", "weights = heavy", "a list of numbers"]),
        ('procedure = "load-sweep"\nwith = { weights = [1, true] }', ["step 2", "a finite number"]),
    ],
)
def test_a_step_that_no_procedure_can_make_is_refused_with_its_number(step: str, words: list[str]) -> None:
    with pytest.raises(UsageError) as refused:
        items_of(plan(REST, f"\n[[step]]\n{step}\n").file, "small.toml")
    for word in words:
        assert word in str(refused.value)


def test_a_plan_that_does_not_exist_is_refused_with_the_nearest_that_does() -> None:
    with pytest.raises(UsageError, match="no plan called 'papers'; did you mean 'paper'"):
        read_plan("papers")


@pytest.mark.parametrize("path", sorted(PLANS.glob("*.toml")), ids=lambda path: path.stem)
def test_the_plans_that_ship_are_named_like_their_files_and_unfold(path) -> None:  # type: ignore[no-untyped-def]
    found = read_plan(path.stem)
    assert found.file.name == path.stem
    assert len(items_of(found.file, path.name)) >= len(found.file.step)


def test_a_load_sweep_makes_every_weight_twice_once_up_and_once_down() -> None:
    items = items_of(plan_of("load-sweep", {"weights": [5, 0.5, 2]}).file, "load-sweep")
    assert [item.rigging.tau_ext for item in items] == [0.5, 2.0, 5.0, 5.0, 2.0, 0.5]
    assert {item.procedure.name for item in items} == {"kinematic_error"}


def test_an_assembly_sweep_fits_the_reference_depth_anew_and_counts_assemblies() -> None:
    items = items_of(plan_of("assembly-sweep", {"weights": [0], "depths_mm": [0.3], "reference": 2}).file, "x")
    assert [(item.rigging.assembly, item.rigging.depth_mm) for item in items] == [(1, 0.0), (2, 0.0), (3, 0.3)]


def test_identify_is_a_slow_run_friction_every_speed_both_ways_and_a_lock_test_last() -> None:
    items = items_of(plan_of("identify", {"speeds_rpm": [300, 120], "revolutions": 25}).file, "identify")
    assert [item.procedure.name for item in items] == [
        "kinematic_error", "friction", *["constant_torque"] * 4, "stiffness_lock",
    ]  # fmt: skip
    told = [item.procedure for item in items if isinstance(item.procedure, ConstantTorque)]
    assert [t.speed_rpm for t in told] == [120.0, 300.0, -120.0, -300.0]
    assert {t.revolutions for t in told} == {25}
    with pytest.raises(UsageError, match="at least two speeds"):
        items_of(plan_of("identify", {"speeds_rpm": [300, -300]}).file, "identify")


def test_what_was_run_by_name_is_taken_up_by_its_own_plan_though_one_of_that_name_ships(tmp_path: Path) -> None:
    made = planned(plan_of("identify", {"revolutions": 25}), read("twin"), 1)
    journal = new_journal(tmp_path, made, "virtual", [])
    assert "identify" in {path.stem for path in PLANS.glob("*.toml")}
    assert _plan_of(journal) == str(journal.folder / "plan.toml")
    again = planned(read_plan(_plan_of(journal)), read("twin"), 1)
    refuse_other_campaign(journal, again)
    assert len(again.items) == len(made.items)


def test_a_step_without_a_depth_stays_in_the_assembly_of_the_step_before() -> None:
    items = items_of(plan(REST, REST + "depth_mm = 0.1\n", REST).file, "x")
    assert [(item.rigging.assembly, item.rigging.depth_mm) for item in items] == [(1, 0.0), (2, 0.1), (2, 0.1)]
