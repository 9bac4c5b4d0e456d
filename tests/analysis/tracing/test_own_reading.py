"""A law that is a function of the torque it corrects may not take that torque away."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit import search
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.own_reading import TAKEN, leaves_most
from rig.analysis.tracing.nameless.readings import Droop, SensorScale
from rig.analysis.tracing.selection.confounders import CONFOUNDERS
from rig.model.effect import Port
from rig.model.effects import CATALOGUE
from tests.contract.test_effects import motion

STEADY, NOISE = 0.5, 0.004  # N·m: one speed without weights


def equations(rng: np.random.Generator) -> Any:
    tau_m = STEADY + NOISE * rng.standard_normal(motion().t.size)
    return SimpleNamespace(runs=[SimpleNamespace(pieces=[replace(motion(), tau_m=tau_m)])])


@pytest.mark.parametrize(("square", "cube", "leaves"), [
    (0.05, 0.0, True),  # 2.5 % of it
    (1.0 / STEADY, 0.0, False),  # all of it
    (-1.0 / STEADY, 1.0 / STEADY**2, False),  # nothing of it, and all of its changes: 1 − 2·(−1) − 3·1 = 0
    (0.0, 0.1, True),
])  # fmt: skip
def test_a_constant_that_droops_leaves_most_of_the_torque_and_of_its_changes(
    rng: np.random.Generator, square: float, cube: float, leaves: bool
) -> None:
    assert leaves_most(equations(rng), [0], Term(Droop(), ()), np.array([square, cube])) is leaves


def test_a_scale_that_is_off_by_all_of_it_is_none(rng: np.random.Generator) -> None:
    for off, leaves in ((0.9 * TAKEN, True), (1.0, False)):
        assert leaves_most(equations(rng), [0], Term(SensorScale(), ()), np.array([off])) is leaves


def test_a_law_that_takes_it_by_now_is_dropped_from_the_search(
    rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It came in with less; a true effect that it made needless since is asked for again without it."""
    droop, friction = Term(Droop(), ()), Term(CATALOGUE["load_dependent_friction"], (1.0, 1.0))
    monkeypatch.setattr(search, "reduced", lambda d, gone: [t for i, t in enumerate(d.terms) if i not in gone])
    monkeypatch.setattr(search, "fit", lambda terms: SimpleNamespace(design=SimpleNamespace(terms=terms)))
    for square, dropped in ((0.05, set()), (1.0 / STEADY, {droop})):
        places = [slice(0, 2), slice(2, 4)]
        d = SimpleNamespace(eq=equations(rng), terms=[droop, friction], place=places.__getitem__)
        s: Any = SimpleNamespace(design=d, x=np.array([square, 0.0, 1.0, 1.0]))
        left, gone = search._without_greedy(s, [0])
        assert gone == dropped
        assert set(left.design.terms) == {droop, friction} - dropped


def test_an_effect_of_the_gear_may_be_as_large_as_it_likes(rng: np.random.Generator) -> None:
    friction = CATALOGUE["load_dependent_friction"]
    assert leaves_most(equations(rng), [0], Term(friction, (1.0, 1.0)), np.array([1e9, 1e9]))


@pytest.mark.parametrize("name", sorted(CONFOUNDERS))
def test_every_law_that_says_of_which_reading_it_is_acts_there(name: str) -> None:
    effect = CONFOUNDERS[name].effect
    port = {"": None, "tau_m": Port.READS_TAU_M, "torque": Port.READS_TAU_L}[effect.of_reading]
    assert port is None or set(effect.columns(motion(), (0.0,) * len(effect.shape_names))) == {port}
