"""A vibration is named where it swells too, though one wave of constant size leaves half of it."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.floor import vibration
from tests.analysis.tracing.spiked import Columns, spiked, under

CARRIER, SWELL, SIZE = 4.1, 0.31, 0.25  # Hz, Hz, N·m: well below the resonance at 15 Hz


def swelling(c: Columns, began: float) -> Columns:
    t = c["t"] + began
    return under(c, SIZE * (1 + 0.9 * np.sin(2 * np.pi * SWELL * t)) * np.sin(2 * np.pi * CARRIER * t))


@pytest.mark.slow
@pytest.mark.long
def test_a_vibration_that_swells_is_named_with_its_lines(tmp_path: Path, shared: Path) -> None:
    found = spiked(tmp_path, shared / "cases" / "open-1", swelling)
    assert found.verdict.status == Status.EXPLAINED
    assert found.verdict.effects == ("external_vibration",)
    values = {p.name: p.value for p in found.effects[0].parameters}
    assert values["frequency"] == pytest.approx(CARRIER, abs=0.01)
    assert values["torque_amplitude"] == pytest.approx(SIZE, rel=0.1)
    assert sorted(values[f"frequency_{i}"] for i in (2, 3)) == pytest.approx(
        [CARRIER - SWELL, CARRIER + SWELL], abs=0.02
    )


def test_stretches_of_one_log_are_what_several_runs_would_be(monkeypatch: pytest.MonkeyPatch) -> None:
    t = 0.01 * np.arange(16_000)
    theta = np.cumsum(0.01 * (2.0 + 10.0 * (np.floor(t / 40.0) % 2)))  # 2 and 12 rad/s in turn
    monkeypatch.setattr(vibration, "clock", lambda eq, key: t)
    eq: Any = SimpleNamespace(rows={(0, "L"): SimpleNamespace(theta_m=theta)}, runs=[SimpleNamespace(turning=7.0)])
    assert [speed for _, _, speed in vibration._parts(eq, (0, "L"), np.zeros(t.size), 1)] == [7.0]
    parts = vibration._parts(eq, (0, "L"), np.arange(t.size, dtype=float), 8)
    assert np.array_equal(np.concatenate([x for _, x, _ in parts]), np.arange(t.size))
    assert [speed for _, _, speed in parts] == pytest.approx([2.0, 2.0, 12.0, 12.0, 2.0, 2.0, 12.0, 12.0], rel=0.01)


@pytest.mark.parametrize("hz", [11.0, 37.54])
def test_a_line_above_what_slow_runs_resolve_is_told_by_the_fast_ones(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator, hz: float
) -> None:
    """Rows of slow runs lie 16 ms apart: there a line at 37.54 Hz stands at 24.96 Hz."""
    apart = [0.016] * 8 + [0.004] * 9
    times = [dt * np.arange(round(20.0 / dt)) for dt in apart]
    monkeypatch.setattr(vibration, "clock", lambda eq, key: times[key[0]])
    rows = {(i, "L"): SimpleNamespace(theta_m=np.zeros(t.size)) for i, t in enumerate(times)}
    eq: Any = SimpleNamespace(rows=rows, runs=[SimpleNamespace(turning=2.0 + i) for i in range(len(apart))])
    e = {(i, "L"): np.sin(2 * np.pi * hz * t + i) + 0.1 * rng.standard_normal(t.size) for i, t in enumerate(times)}
    assert vibration._loudest(eq, e) == pytest.approx(hz, abs=0.005)


def test_runs_that_all_go_through_the_same_speeds_tell_by_their_stretches(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    """Of six stairs of the torque each turns as fast as the others in the mean, and at every speed within."""
    t = 0.008 * np.arange(5000)
    monkeypatch.setattr(vibration, "clock", lambda eq, key: t)
    wave = {(i, "L"): np.sin(2 * np.pi * 6.37 * t + i) + 0.3 * rng.standard_normal(t.size) for i in range(6)}
    for speed, found in ((5.0 + 40.0 * t / t[-1], 6.37), (25.0 + 0.0 * t, None)):
        rows = {key: SimpleNamespace(theta_m=0.008 * np.cumsum(speed)) for key in wave}
        eq: Any = SimpleNamespace(rows=rows, runs=[SimpleNamespace(turning=25.0)] * 6)
        hz = vibration._loudest(eq, wave)
        assert hz == (found and pytest.approx(found, abs=0.005))


@pytest.mark.parametrize(("half", "is_one"), [(0.01, True), (0.08, False)])
def test_a_line_whose_torque_may_be_nothing_is_no_vibration(half: float, is_one: bool) -> None:
    line = vibration.Line(52.84, {"A": 0.0, "L": 0.065}, 0.001, half, 0.065)
    assert line.of_the_load(7000.0) == is_one


def test_a_line_in_proportion_to_the_speed_is_no_torque(rng: np.random.Generator) -> None:
    """A delay that swings makes one of a turning angle, and nothing at rest."""
    speeds = np.repeat([1.0, 6.0, 12.0, 21.0, 31.0, 42.0], 2)
    for sizes, is_one in ((0.012 * speeds, False), (0.25 + 0.0 * speeds, True)):
        at_rest = vibration._at_rest(speeds, sizes + 0.004 * rng.standard_normal(speeds.size))
        line = vibration.Line(41.9, {"A": 0.0, "L": 0.25}, 0.001, 0.05, 0.25, at_rest=at_rest)
        assert line.of_the_load(7500.0) is is_one
    assert vibration._at_rest(speeds[:2], 0.012 * speeds[:2]) == 1.0


@pytest.mark.parametrize(
    ("hz", "strokes"),
    [([13.2, 16.5, 9.9, 3.3], True), ([10.4, 10.63, 10.17, 20.8], False), ([4.1, 8.2, 12.3, 16.42], True)],
)
def test_lines_at_whole_multiples_of_how_often_it_strikes_are_one_vibration(hz: list[float], strokes: bool) -> None:
    assert vibration._in_strokes(hz) is strokes
