"""A step of the zeros between two runs: counts that were lost while nobody recorded."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor import between_runs as module
from rig.analysis.tracing.floor import offsets
from rig.analysis.tracing.floor.between_runs import Between, find_between
from rig.analysis.tracing.floor.offsets import own_angle

ARCSEC = np.pi / 180 / 3600
RUNS, LASTS, EVERY, AT = 20, 10.0, 40.0, 9  # s
SOFT = 1.4e-4  # rad/(N·m)
STEP, WANDER = 9.0 * ARCSEC, 0.3 * ARCSEC


def found(
    monkeypatch: pytest.MonkeyPatch,
    zeros: Sequence[float],
    pause: float = 0.0,
    conditions: int = 5,
    of_the_torque: Sequence[float] | None = None,
) -> Between | None:
    """Of runs with those zeros [rad], one every EVERY s and a `pause` before run AT; conditions come in turn. And with
    zeros of the load's balance [N·m]."""
    begun = [EVERY * i + (pause if i >= AT else 0.0) for i in range(len(zeros))]
    runs = [
        SimpleNamespace(start=t, locked=False, said=i % conditions, pieces=[SimpleNamespace(t=[t, t + LASTS])])
        for i, t in enumerate(begun)
    ]
    known = {"A": zeros} if of_the_torque is None else {"A": zeros, "L": of_the_torque}
    rows = {(i, channel): SimpleNamespace(y=np.zeros(50)) for i in range(len(zeros)) for channel in known}
    s: Any = SimpleNamespace(
        design=SimpleNamespace(eq=SimpleNamespace(runs=runs, rows=rows), terms=()),
        value=lambda name: {"compliance": SOFT}[name],
    )
    for where, name in ((module, "zero"), (offsets, "offset")):
        monkeypatch.setattr(where, name, lambda _, run, channel: known[channel][run])
    monkeypatch.setattr(module, "alike", lambda a, b: a.said == b.said)
    return find_between(s, range(len(zeros)))


def stepped(rng: np.random.Generator, size: float = STEP) -> np.ndarray:
    """Zeros that wander a little, and from run AT on by `size` more."""
    return WANDER * rng.standard_normal(RUNS) + np.where(np.arange(RUNS) >= AT, size, 0.0)


def test_every_run_from_the_step_on_has_a_zero_of_its_own(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    between = found(monkeypatch, stepped(rng))
    assert between
    assert between.runs == tuple(range(AT, RUNS))
    assert between.sizes == pytest.approx([STEP], abs=2 * between.half_widths[0])
    assert between.half_widths[0] < 0.05 * STEP
    named: Any = SimpleNamespace(runs=[SimpleNamespace(name=f"run {i}") for i in range(RUNS)])
    assert "step once, between the runs run 8 and run 9, while" in between.sentence(named)
    eq: Any = SimpleNamespace(rows={(i, "A"): SimpleNamespace(y=np.zeros(7)) for i in range(RUNS)})
    assert {key: x.tolist() for key, x in between.columns(eq).items()}[AT, "A"] == [[1.0]] * 7


def test_the_interval_of_its_size_covers(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    hits = [abs(b.sizes[0] - STEP) < b.half_widths[0] for _ in range(200) if (b := found(monkeypatch, stepped(rng)))]
    assert len(hits) == 200
    assert 0.88 <= np.mean(hits) <= 0.99


def several(rng: np.random.Generator, *levels: float) -> np.ndarray:
    """Zeros that wander a little about one level after the other, in steps of STEP."""
    return WANDER * rng.standard_normal(RUNS) + STEP * np.repeat(levels, -(-RUNS // len(levels)))[:RUNS]


def test_counts_are_lost_three_times_and_every_level_is_told_from_the_others(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    between = found(monkeypatch, several(rng, 0.0, 1.0, 3.0, 2.0))
    assert between
    assert between.levels == tuple(tuple(range(at, at + 5)) for at in range(0, RUNS, 5))
    assert between.sizes == pytest.approx([STEP, 2 * STEP, -STEP], abs=3 * between.half_widths.max())
    words = {p.name: p.value for p in between.parameters()}
    assert words == {"steps": 3.0, "step_theta_l": pytest.approx(2 * STEP, rel=0.1)}
    named: Any = SimpleNamespace(runs=[SimpleNamespace(name=f"run {i}") for i in range(RUNS)])
    assert "three times, between the runs run 4 and run 5, between the runs run 9 and run 10 and" in between.sentence(
        named
    )
    eq: Any = SimpleNamespace(rows={(i, "A"): SimpleNamespace(y=np.zeros(7)) for i in range(RUNS)})
    columns = between.columns(eq)
    assert columns.keys() == {(i, "A") for i in range(5, RUNS)}
    assert len({float(columns[i, "A"][0, 0]) for i in (5, 10, 15)}) == 3


def test_a_zero_that_comes_back_was_never_lost(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    for levels in ((0.0, 1.0, 0.0), (0.0, 1.0, 0.0, 1.0), (0.0, 1.0, 2.0, 1.0)):
        assert not any(found(monkeypatch, several(rng, *levels)) for _ in range(20))


def test_levels_with_no_condition_in_common_may_be_the_conditions(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    zeros = several(rng, 0.0, 1.0, 3.0, 2.0)
    assert found(monkeypatch, zeros, conditions=10) is None, "the first is like the third, the second like the fourth"
    assert found(monkeypatch, zeros, conditions=7), "all hang together"


def test_zeros_that_wander_or_drift_or_warm_up_are_no_step(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    t = np.arange(RUNS)
    for zeros in (0.0 * t, STEP * t / RUNS, STEP * (1 - np.exp(-t / 4.0)), STEP * np.sign(np.sin(t))):
        assert not any(found(monkeypatch, zeros + WANDER * rng.standard_normal(RUNS)) for _ in range(20))
    assert not any(found(monkeypatch, stepped(rng, 3 * WANDER)) for _ in range(20))
    assert sum(found(monkeypatch, np.cumsum(WANDER * rng.standard_normal(RUNS))) is not None for _ in range(300)) <= 2


def test_after_a_longer_break_somebody_may_have_homed_the_encoder(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    assert found(monkeypatch, stepped(rng), pause=100.0) is None


def test_without_a_condition_on_both_sides_it_may_be_the_condition(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    assert found(monkeypatch, stepped(rng), conditions=RUNS) is None
    assert found(monkeypatch, stepped(rng)[AT - 2 : AT + 3]) is None, "of five runs none is told apart"


def test_repeats_on_either_side_of_a_step_do_not_tell_how_zeros_wander() -> None:
    y = {0: 0.0, 1: 1e-6, 2: 5e-5, 3: 5.1e-5, 4: 5e-5, 5: 5.1e-5, 6: 0.0, 7: 5e-5}
    rows = {(i, "A"): SimpleNamespace(y=np.full(9, zero), z=np.zeros((9, 1)), at=(0,)) for i, zero in y.items()}
    own = {(i, "A"): np.ones((9, 1)) for i, zero in y.items() if zero > 2e-5}
    eq = SimpleNamespace(rows=rows, own=own)
    s: Any = SimpleNamespace(design=SimpleNamespace(eq=eq), keys=list(rows), x=np.zeros(1))
    pairs = [(0, 1), (2, 3), (4, 5), (6, 7)]
    assert own_angle(s, pairs, 1e-9) == pytest.approx(1e-6 / np.sqrt(2))
    eq.own = {}
    assert own_angle(s, pairs, 1e-9) > 1e-5


def test_a_step_of_ten_times_what_zeros_wander_by_is_found_and_one_beside_a_quick_start_is_not(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    assert all(found(monkeypatch, stepped(rng, 10 * WANDER)) for _ in range(20))
    quick = STEP * np.exp(-np.arange(40) / 1.5)  # forty runs, of which the first three stand apart
    assert not any(found(monkeypatch, quick + 0.2 * WANDER * rng.standard_normal(40)) for _ in range(20))


def test_a_torque_sensor_that_was_tared_anew_is_no_lost_count(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    zeros = stepped(rng)
    assert found(monkeypatch, zeros, of_the_torque=0.2 * rng.standard_normal(RUNS))
    tared = -(zeros - zeros.mean()) / SOFT + 0.1 * rng.standard_normal(RUNS)
    assert found(monkeypatch, zeros, of_the_torque=tared) is None
