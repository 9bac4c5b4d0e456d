"""The generator of the blind test: truth apart, same seed same bytes, no effect no change, folders any reader takes."""

from __future__ import annotations

import ast
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.blind import cases, folder, plans, suite
from tests.blind import rig as rigs
from tests.blind.builder import Builder
from tests.blind.campaign import simulate
from tests.blind.forms import EFFECTS, LIBRARY, OUTSIDE
from tests.blind.plans import Plan, RunPlan
from tests.blind.sensors import draw_noise
from tests.blind.strength import Stage, shape_rng
from tests.blind.taken import Taken

HERE = Path(__file__).parent
COORDINATES = {
    "motor_angle", "load_angle", "speed", "load", "direction", "time", "time_periodic", "temperature", "memory",
}  # fmt: skip


def stage(plan: Plan, seed: int = 3) -> Stage:
    rng = np.random.default_rng(seed)
    return Stage(rigs.draw(rng, *plan.resonance_hz), draw_noise(rng), plan, seed)


def tiny() -> Plan:
    """Half a minute of rig: a steady run, a lock and a loaded triangle, all cut short."""
    fast = replace(plans.steady(120, "1"), duration_s=2.0)
    slow: RunPlan = replace(plans.loaded(5.0, "1"), duration_s=4.0, lead_s=1.0)
    return Plan("tiny", plans.started([fast, slow, replace(plans.lock(20, "1"), duration_s=3.0)], 5.0))


def taken(builder: Builder, on: Stage) -> list[Taken]:
    return simulate(builder, on.plan, on.noise, on.seed)


@pytest.mark.slow
def test_no_line_of_the_blind_test_imports_the_program() -> None:
    for path in HERE.rglob("*.py"):
        if path.name.startswith("test_"):
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            assert not [n for n in names if n.split(".")[0] in ("rig", "sim", "drivers")], f"{path}: {names}"


def test_every_effect_has_a_textbook_form_and_another() -> None:
    assert len(EFFECTS) == 25
    for effect in EFFECTS:
        own = [form for form in LIBRARY if form.effect == effect]
        assert [form.textbook for form in own].count(True) == 1, effect
        assert len(own) >= 2, effect


def test_the_effects_outside_live_in_all_nine_coordinates() -> None:
    assert {form.coordinates[0] for form in OUTSIDE} == COORDINATES
    assert all(set(form.coordinates) <= COORDINATES for form in OUTSIDE)


def test_a_form_draws_the_same_shape_at_every_strength() -> None:
    on = stage(tiny())
    for form in (*LIBRARY, *OUTSIDE):
        draws = []
        for strength in (0.5, 1.0):
            rng = shape_rng(5, 0)
            form.build(Builder(on.rig), rng, strength)
            draws.append(rng.random())
        assert draws[0] == draws[1], form


def test_a_suite_holds_every_kind_and_asks_for_effects_in_turn() -> None:
    asked = suite.requests(30, seed=1)
    assert len(asked) == 30
    assert {request.kind for request in asked} == set(cases.KINDS)
    named = [request.effect for request in asked if request.kind.startswith("single")]
    assert len(set(named)) == len(named)
    assert asked == suite.requests(30, seed=1)
    assert asked != suite.requests(30, seed=2)


def test_the_complete_plan_has_the_runs_of_the_reference_campaigns(shared: Path) -> None:
    # a trace that was tried on them leaves its report beside the runs
    there = {path.parent.name for path in (shared / "cases" / "open-1").glob("*/manifest.json")}
    assert {run.name for run in plans.complete().runs} == there


def test_two_effects_that_claim_the_same_part_are_refused() -> None:
    builder = Builder(stage(tiny()).rig)
    builder.set(extra=1)
    with pytest.raises(ValueError, match="two effects of one case claim"):
        builder.set(extra=2)


@pytest.mark.slow
def test_the_same_seed_gives_the_same_bytes_and_another_seed_others(tmp_path: Path) -> None:
    plan, sums = tiny(), []
    for name, seed in (("a", 3), ("b", 3), ("c", 4)):
        on = stage(plan, seed)
        sums.append(folder.write_campaign(taken(Builder(on.rig), on), tmp_path / name, plan, on.rig))
    assert sums[0] == sums[1] != sums[2]


@pytest.mark.slow
def test_an_effect_of_no_strength_leaves_every_row_as_it_was() -> None:
    on = stage(tiny())
    clean = taken(Builder(on.rig), on)
    builder = Builder(on.rig)
    form = next(form for form in LIBRARY if form.effect == "position_dependent_friction")
    form.build(builder, shape_rng(3, 0), 0.0)
    for one, other in zip(clean, taken(builder, on), strict=True):
        for name, column in one.columns.items():
            np.testing.assert_array_equal(column, other.columns[name])


@pytest.mark.slow
def test_a_campaign_holds_no_word_of_what_is_hidden(tmp_path: Path) -> None:
    on = stage(tiny())
    folder.write_campaign(taken(Builder(on.rig), on), tmp_path / "case", on.plan, on.rig)
    words = {*EFFECTS, "strength", "hidden", "true", "K_true", str(on.rig.K)}
    for path in (tmp_path / "case").rglob("manifest.json"):
        text = path.read_text(encoding="utf-8")
        assert not [word for word in words if f'"{word}"' in text or (word == str(on.rig.K) and word in text)]
        assert json.loads(text)["declared"]["K"] == rigs.NOMINAL_K


@pytest.mark.slow
def test_the_programs_reader_takes_the_folders(tmp_path: Path) -> None:
    from rig.runfile.run import Run

    on = stage(tiny())
    folder.write_campaign(taken(Builder(on.rig), on), tmp_path / "case", on.plan, on.rig)
    run = Run.open(tmp_path / "case" / "load_5nm_1")
    assert run.rows == 1000
    assert run.conditions == {"tau_ext": -5.0, "output_locked": False}
    assert run.ratio == 50
