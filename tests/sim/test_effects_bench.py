"""[twin.effects] of the bench files: off in `twin`, the paper's findings in `twin-paper`, each key can be set."""

from __future__ import annotations

import dataclasses
import tomllib
from typing import Any

import pytest

from rig.bench import BENCHES, read, twin_parameters
from rig.config.effects import EffectsSection
from rig.core.errors import UsageError
from sim.effects import Effects
from sim.parameters import TwinParameters

SHIPPED = ("twin", "twin-paper")


def parameters(bench: str = "twin", *overrides: str) -> TwinParameters:
    made: TwinParameters = twin_parameters(read(bench, list(overrides)).file)
    return made


def test_the_bench_file_and_the_twin_know_the_same_keys_with_the_same_values_when_off() -> None:
    assert EffectsSection().model_dump() == dataclasses.asdict(Effects())


@pytest.mark.parametrize("bench", SHIPPED)
def test_each_key_stands_in_the_file_with_value_unit_and_provenance(bench: str) -> None:
    sections: dict[str, Any] = tomllib.loads((BENCHES / f"{bench}.toml").read_text(encoding="utf-8"))["twin"]["effects"]
    for name, numbers in dataclasses.asdict(Effects()).items():
        assert sections[name].keys() == numbers.keys()
        for entry in sections[name].values():
            assert {"value", "unit", "from"} <= entry.keys()


def test_the_twin_is_the_papers_model_and_twin_paper_has_what_its_authors_found() -> None:
    assert parameters().effects == Effects()
    assert not parameters().effects.in_the_plant
    found = parameters("twin-paper").effects
    assert found.load_dependent_error.A_inf < 0.7
    assert found.assembly.error_per_mm > 0.0
    assert found.stiffness.K3 > found.stiffness.K2 > parameters("twin-paper").gear.K
    assert found.hysteresis.torque > 0.0
    assert found.sensors == Effects().sensors


def test_every_effect_can_be_set() -> None:
    special = {"filter": 0.04, "T1": 4.0, "T2": 9.0, "K2": 9e3, "K3": 1e4}
    wanted = {
        (name, key): special.get(key, {int: 7, float: 0.004}[type(off)])
        for name, numbers in dataclasses.asdict(Effects()).items()
        for key, off in numbers.items()
    }
    made = parameters("twin", *[f"twin.effects.{name}.{key}={value}" for (name, key), value in wanted.items()]).effects
    assert {(name, key): getattr(getattr(made, name), key) for name, key in wanted} == wanted
    assert made.in_the_plant


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("twin.effects.hysteresis.elements=0", "greater than or equal to 1"),
        ("twin.effects.hysteresis.width=1", "no key 'twin.effects.hysteresis.width'"),
        ("twin.effects.friction.by_angle=1.5", "less than 1"),
        ("twin.effects.stiffness.T1=4", "expected T2 of at least T1, K2 and K3 above 0"),
        ("twin.effects.load_dependent_error.T_c=0", "greater than 0"),
        ("twin.effects.load_dependent_errors.T_c=1", "did you mean 'load_dependent_error'"),
    ],
)
def test_what_cannot_be_is_refused_with_the_key(override: str, words: str) -> None:
    with pytest.raises(UsageError, match=r"twin\.effects") as refusal:
        parameters("twin", override)
    assert words in str(refusal.value)


def test_a_bench_file_without_effects_has_none(tmp_path: Any) -> None:
    text = (BENCHES / "twin.toml").read_text(encoding="utf-8")
    path = tmp_path / "old.toml"
    path.write_text(text[: text.index("[twin.effects]")], encoding="utf-8")
    assert parameters(str(path)).effects == Effects()
