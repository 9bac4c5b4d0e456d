"""Sizes that runs want of an effect: what repeats differ by as well is no sign of another law."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.runs.holdout import HELD_PART
from rig.analysis.tracing.selection import as_repeats as module
from rig.analysis.tracing.selection.as_repeats import as_repeats
from rig.analysis.tracing.selection.done import Without
from rig.analysis.tracing.selection.score import HeldOutScore

CONDITIONS, ROWS = 12, 1000
LOCKED = -1  # a condition more, whose output is
SWINGS = np.where(np.arange(CONDITIONS) % 2, 1.0, -1.0)


@pytest.fixture(autouse=True)
def _said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "alike", lambda a, b: bool(a.said == b.said))


def taken_away(rng: np.random.Generator, sizes: list[tuple[int, str, float]], lone: bool = False) -> Without:
    """Runs by condition, name and the size they want of an effect whose fitted size is 1; noise of a row: 1 floor. With
    a `lone` channel that one run of each condition has."""
    f = [rng.standard_normal(ROWS) for _ in sizes]
    left = [(size - 1.0) * one + rng.standard_normal(ROWS) for one, (_, _, size) in zip(f, sizes, strict=True)]
    runs = [
        SimpleNamespace(said=condition, name=name, procedure="speed", locked=condition == LOCKED)
        for condition, name, _ in sizes
    ]
    once = [(i, "A") for i, run in enumerate(runs) if lone and run.name.endswith(".0")]
    keys = [*((i, "M") for i in range(len(sizes))), *once]
    eq = SimpleNamespace(noise=SimpleNamespace(kappa={"M": 1.0, "A": 1.0}), runs=runs)
    design: Any = SimpleNamespace(eq=eq)
    rest: Any = None
    return Without(rest, design, {k: left[k[0]] for k in keys}, {k: left[k[0]] + f[k[0]] for k in keys}, {})


def said(
    rng: np.random.Generator,
    wander: float,
    law: float = 0.0,
    later: float = 1.0,
    repeats: int = 3,
    parts: bool = False,
    lone: bool = False,
    locked: float = 0.0,
) -> bool:
    """Of an effect that every condition shows in another size by `law`, every run by `wander`; the last repeat of each
    is unseen. With `parts` the repeats are parts of one run, with `locked` those whose output is want so much more."""
    shown = [
        (c, f"run {c}" + (f" ({HELD_PART})" if r else "") if parts else f"run {c}.{r}", 1.0 + law * SWINGS[c] + drawn)
        for c in range(CONDITIONS)
        for r, drawn in enumerate(wander * rng.standard_normal(repeats))
    ]
    shown += [(LOCKED, f"lock.{r}", 1.0 + locked) for r in range(repeats) if locked]
    last = [one for k, one in enumerate(shown) if k % repeats == repeats - 1]
    unseen = taken_away(rng, [(c, name, size * later) for c, name, size in last], lone)
    seen = taken_away(rng, [one for k, one in enumerate(shown) if k % repeats != repeats - 1 or repeats == 1], lone)
    at: Any = SimpleNamespace(floors=dict.fromkeys(unseen.left, 1.0), seen=dict.fromkeys(seen.left, 1.0))
    return as_repeats(seen, unseen, at)


def test_sizes_that_wander_as_much_between_repeats_are_one_size(rng: np.random.Generator) -> None:
    assert sum(said(rng, 0.3) for _ in range(40)) >= 36


def test_sizes_that_differ_between_conditions_alone_are_another_law(rng: np.random.Generator) -> None:
    assert not any(said(rng, 0.1, law=0.3) for _ in range(40))


def test_what_unseen_runs_want_in_another_size_is_another_law(rng: np.random.Generator) -> None:
    assert not any(said(rng, 0.1, later=1.4) for _ in range(40))


def test_what_repeats_differ_by_as_much_as_it_does_is_not_plainly_there(rng: np.random.Generator) -> None:
    assert not any(said(rng, 1.5) for _ in range(40))


def test_without_repeats_nothing_is_said_and_parts_of_a_run_are_none(rng: np.random.Generator) -> None:
    assert not said(rng, 0.0, repeats=1)
    assert said(rng, 0.1, repeats=2)
    assert not said(rng, 0.1, repeats=2, parts=True)


def test_a_channel_that_was_measured_once_in_every_condition_leaves_it_unsaid(rng: np.random.Generator) -> None:
    assert said(rng, 0.1)
    assert not said(rng, 0.1, lone=True)


def test_what_locked_runs_want_says_nothing_of_friction(rng: np.random.Generator) -> None:
    """A motor that creeps against a spring sticks and slips."""
    assert said(rng, 0.1, locked=-2.0)


def test_it_stands_in_for_steadiness_and_for_nothing_else() -> None:
    wandering = HeldOutScore("load_dependent_friction", 1.2, 1.4, 0.8, 1.41, (), unsteady=0.65, apart=0.65)
    assert not wandering.named
    assert not wandering.fairly
    steady = HeldOutScore(
        "load_dependent_friction", 1.2, 1.4, 0.8, 1.41, (), unsteady=0.65, apart=0.65, as_repeats=True
    )
    assert steady.named
    assert steady.fairly
    assert not HeldOutScore("load_dependent_friction", 0.2, 1.4, 0.8, 1.0, (), as_repeats=True).named  # of the excess
    assert not HeldOutScore("load_dependent_friction", 1.2, 0.3, 0.8, 1.0, (), as_repeats=True).named  # too small
    assert not HeldOutScore("load_dependent_friction", 1.2, 1.4, 0.8, 1.0, (), harm=1.2, as_repeats=True).named
