"""A spring that gives more in the later of two runs taken alike is told from repeats that differ by something else."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.residual import same_spring as module
from rig.analysis.tracing.residual.same_spring import OtherSpring, same_spring
from rig.model.effect import Array

ROWS, PAIRS, NOISE, SOFT = 1000, 6, 4e-6, 1e-4  # rows, pairs, rad, rad/(N·m)
TORQUE = 2.0 * np.sin(np.arange(ROWS) / 30.0) + 0.5  # N·m


def apart(eq: Any, e: dict[Key, Array], pair: tuple[int, int], channel: str) -> Any:
    """What two runs at the same angles differ by."""
    d = (e[pair[0], channel] - e[pair[1], channel]) / np.sqrt(2)
    return SimpleNamespace(rows=d.size, rms=float(np.sqrt(np.mean((d - d.mean()) ** 2))))


@pytest.fixture
def found(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> Callable[..., OtherSpring | None]:
    """Of pairs of runs, the later one with these residuals [rad] more, besides noise and a zero of its own."""
    monkeypatch.setattr(module, "at_rows", lambda eq, key, name: TORQUE)
    monkeypatch.setattr(module, "scatter", apart)

    def of(later: Callable[[int], Array], pairs: int = PAIRS, has: frozenset[str] = frozenset({"tau_l"})) -> Any:
        alike = [(2 * k, 2 * k + 1) for k in range(pairs)]
        monkeypatch.setattr(module, "repeats", lambda runs, among: [pair for pair in alike if {*pair} <= {*among}])
        runs = [SimpleNamespace(name=f"run {i}", locked=False, has=has, start=60.0 * i) for i in range(2 * pairs)]
        eq: Any = SimpleNamespace(runs=runs)
        e = {(i, "A"): NOISE * rng.standard_normal(ROWS) + 1e-5 * rng.standard_normal() for i in range(2 * pairs)}
        for k in range(pairs):
            e[2 * k + 1, "A"] = e[2 * k + 1, "A"] + later(k)
        return same_spring(eq, e, SOFT)

    return of


@pytest.mark.parametrize("softer", [0.1, -0.1])
def test_one_that_gives_more_or_less_later_is_told_with_how_much(
    found: Callable[..., OtherSpring | None], softer: float
) -> None:
    other = found(lambda k: softer * SOFT * TORQUE)
    assert other is not None
    assert other.softer == pytest.approx(softer, rel=0.05)
    assert other.share > 0.8
    assert f"{abs(other.softer):.1%} {'more' if softer > 0 else 'less'}" in other.sentence()


def test_repeats_that_differ_by_noise_or_by_a_wave_or_now_this_way_now_that_are_not(
    found: Callable[..., OtherSpring | None],
) -> None:
    assert found(lambda k: np.zeros(ROWS)) is None
    assert found(lambda k: 2e-5 * np.sin(np.arange(ROWS) / 7.0)) is None
    assert found(lambda k: (-1) ** k * 0.1 * SOFT * TORQUE) is None  # a gain that is never twice the same


def test_of_few_pairs_and_of_an_unread_torque_nothing_is_said(found: Callable[..., OtherSpring | None]) -> None:
    assert found(lambda k: 0.1 * SOFT * TORQUE, pairs=3) is None
    assert found(lambda k: 0.1 * SOFT * TORQUE, has=frozenset()) is None
