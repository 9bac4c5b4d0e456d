"""Friction that goes with the use or the speed, told by the means of runs that keep their speed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.looks import means
from rig.model.effects.thermal_friction_drift import ThermalFrictionDrift

NIGHT, NOISE = 86_400.0, 0.0005  # s; N·m, how far friction scatters
SPEEDS = np.tile([6.0, 12.5, -6.0, 21.0, 31.0, -21.0, 42.0, -42.0], 2)  # rad/s, the same on both days
USED = np.tile(150.0 * np.arange(8), 2)  # s since the morning


def selected(*names: str, left: dict[tuple[int, str], float] | None = None) -> Any:
    """That stands, of runs that go one way, with so many floors left in blocks of unseen ones."""
    runs = [
        SimpleNamespace(
            locked=False,
            turning=abs(v),
            pieces=[SimpleNamespace(way=np.full(2, np.sign(v)), in_use=np.full(2, t), heat=lambda t_w: np.zeros(2))],
        )
        for v, t in zip(SPEEDS, USED, strict=True)
    ]
    eq = SimpleNamespace(
        runs=runs,
        rows={(i, "M") for i in range(len(runs))},
        noise=SimpleNamespace(sigma={"M": 0.002}, local={"M": 0.0}),
    )
    at = SimpleNamespace(residuals=lambda s, held: left or {}, ratio=lambda e, keys: max(e[key] for key in keys))
    solution = SimpleNamespace(design=SimpleNamespace(eq=eq))
    return SimpleNamespace(names=set(names), solution=solution, held=None, p=SimpleNamespace(held_out=at))


def wanted(
    monkeypatch: pytest.MonkeyPatch,
    friction: Sequence[float] | np.ndarray,
    *names: str,
    left: dict[tuple[int, str], float] | None = None,
) -> bool:
    """Whether a look is wanted where the runs have that much more friction than the baseline, N·m."""
    monkeypatch.setattr(means, "offset", lambda s, run, channel: float(np.sign(SPEEDS[run]) * friction[run]))
    return means.wanted(selected(*names, left=left))


@pytest.mark.parametrize(("channel", "left", "asked"), [
    ("A", 6.0, False), ("L", 6.0, False), ("M", 6.0, True), ("R", 6.0, True), ("A", 1.5, True),
])  # fmt: skip
def test_none_is_wanted_where_something_is_left_that_no_friction_of_the_motor_explains(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator, channel: str, left: float, asked: bool
) -> None:
    falling = scatter(rng) + 0.02 * np.exp(-np.abs(SPEEDS) / 8.0)
    assert wanted(monkeypatch, falling, left={(0, channel): left}) is asked


def scatter(rng: np.random.Generator) -> np.ndarray:
    return NOISE * rng.standard_normal(SPEEDS.size)


def test_a_drive_that_is_cold_every_morning_is_looked_at(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    warming = scatter(rng) + 0.01 * np.exp(-USED / 400.0)
    assert wanted(monkeypatch, warming)
    assert not wanted(monkeypatch, -warming)  # no drive has the more friction the longer it runs
    assert not wanted(monkeypatch, warming, ThermalFrictionDrift.name, "stribeck_friction")


def test_friction_that_falls_with_the_speed_is_looked_at_until_it_is_named(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    falling = scatter(rng) + 0.02 * np.exp(-np.abs(SPEEDS) / 8.0)
    assert wanted(monkeypatch, falling)
    assert not wanted(monkeypatch, falling, "stribeck_friction", ThermalFrictionDrift.name)


def test_friction_that_scatters_is_not(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    assert sum(wanted(monkeypatch, 4.0 * scatter(rng)) for _ in range(100)) < 5


@pytest.mark.parametrize(
    ("before", "after", "loud", "counts"),
    [
        ((), ("thermal_friction_drift",), False, True),
        (("missed_counts",), ("missed_counts", "quadratic_drag", "thermal_friction_drift"), False, True),
        (("missed_counts",), ("thermal_friction_drift",), False, False),  # takes another one's name
        ((), ("thermal_friction_drift",), True, False),
        ((), ("torque_ripple", "stribeck_friction"), False, False),  # no means tell of that
        ((), (), False, False),
    ],
)
def test_the_look_counts_where_it_adds_what_means_tell_of_and_explains_everything(
    monkeypatch: pytest.MonkeyPatch, before: tuple[str, ...], after: tuple[str, ...], loud: bool, counts: bool
) -> None:
    other: Any = SimpleNamespace(names=set(after), loud=loud, left=2.0)
    monkeypatch.setattr(means, "looking", lambda campaign, looks: campaign)
    monkeypatch.setattr(means, "prepare", lambda campaign, hold_out: None)

    def searched(p: object, wanted: frozenset[str], shown: Callable[[Any], bool]) -> tuple[Any, str]:
        assert means.WARMING in wanted
        assert shown(other) == (not wanted.isdisjoint(after))  # else it leaves no less, and nobody need ask for more
        assert shown(SimpleNamespace(names=set(), left=1.0))
        return other, "ranking"

    monkeypatch.setattr(means, "searched", searched)
    so_far: Any = SimpleNamespace(names=set(before), left=2.0, p=SimpleNamespace(campaign=SimpleNamespace(runs=())))
    got, _ = means.taken(so_far, SimpleNamespace(), SimpleNamespace(), ())  # type: ignore[arg-type]
    assert (got is other) is counts


@pytest.mark.parametrize(("left", "counts"), [(1.04, True), (1.06, False)])
def test_the_look_counts_in_the_place_of_a_law_without_a_name_that_leaves_more(
    monkeypatch: pytest.MonkeyPatch, left: float, counts: bool
) -> None:
    other: Any = SimpleNamespace(names={"lost_motion", means.WARMING}, loud=False, left=left)
    so_far: Any = SimpleNamespace(
        names={"lost_motion", "constant_drift"}, left=1.05, p=SimpleNamespace(campaign=SimpleNamespace(runs=()))
    )
    monkeypatch.setattr(means, "looking", lambda campaign, looks: campaign)
    monkeypatch.setattr(means, "prepare", lambda campaign, hold_out: None)
    monkeypatch.setattr(means, "searched", lambda p, wanted, shown: (other, "ranking"))
    got, _ = means.taken(so_far, SimpleNamespace(), SimpleNamespace(), ())  # type: ignore[arg-type]
    assert (got is other) is counts
