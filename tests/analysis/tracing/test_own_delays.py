"""Delays that are another one in every run, told from what else makes repeats differ."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor import own_delays as module
from rig.analysis.tracing.floor.own_delays import OwnDelays, own_delays
from rig.analysis.tracing.outcome.each_run import OWN
from rig.model.effect import Array
from rig.model.effects.channel_time_skew import KNOTS, along

SPEEDS = np.repeat([0.02, 0.13, 0.25, 0.42, 0.63, 0.84], 2)  # rad/s of the output, each taken twice
ROWS, STEP, NOISE, DELAY, SCATTER = 1200, 4e-3, 3e-6, 1.5e-4, 7e-5  # s, rad, s, s


def found(monkeypatch: pytest.MonkeyPatch, left: list[Array], torques: Array | None = None) -> OwnDelays | None:
    """Of runs that leave so much of θ̃."""
    t = STEP * np.arange(ROWS)
    torque = np.full(SPEEDS.size, 5.0) if torques is None else torques

    def term(run: int, made: Any) -> dict[str, Array]:
        way = -speed(run)[:, None]
        return {"A": way * along(t / t[-1]) if made is module.CURVE else way, "M": np.zeros((ROWS, 1))}

    rows = {(i, "A"): SimpleNamespace(y=y, z=np.zeros((ROWS, 0)), at=()) for i, y in enumerate(left)}
    runs = [SimpleNamespace(locked=False, has={"t", "tau_l"}) for _ in left]
    eq = SimpleNamespace(runs=runs, rows=rows, term=term, noise=SimpleNamespace(local={"A": np.inf}))
    s: Any = SimpleNamespace(design=SimpleNamespace(eq=eq), x=np.zeros(0))
    monkeypatch.setattr(module, "clock", lambda _, key: t)
    monkeypatch.setattr(module, "at_rows", lambda _, key, name: np.full(ROWS, torque[key[0]]))
    monkeypatch.setattr(module, "repeats", lambda runs, free: [(i, i + 1) for i in range(0, len(free), 2)])
    return own_delays(s, range(len(left)), range(len(left)))


def speed(run: int) -> Array:
    """It ripples a little, as the kinematic error makes it."""
    return np.asarray(SPEEDS[run] * (1 + 0.02 * np.sin(SPEEDS[run] * 100 * STEP * np.arange(ROWS) + run)))


def noise(rng: np.random.Generator) -> Array:
    return NOISE * rng.standard_normal(ROWS) + 1e-5 * rng.standard_normal()


def wandering(rng: np.random.Generator) -> Array:
    """A curve of RMS near 1, from here to there along a run."""
    return np.interp(np.linspace(0, 1, ROWS), np.linspace(0, 1, 7), rng.standard_normal(7))


def test_delays_that_wander_in_each_run_are_its_own(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    delays = [DELAY + SCATTER * wandering(rng) for _ in SPEEDS]
    late = found(monkeypatch, [noise(rng) - speed(i) * delays[i] for i in range(SPEEDS.size)])
    assert late
    assert late.wander
    mean, scatter = late.parameters()
    assert mean.value == pytest.approx(DELAY, abs=3 * SCATTER / np.sqrt(SPEEDS.size))
    assert scatter.value == pytest.approx(SCATTER, rel=0.4)
    assert late.columns.keys() == {(i, "A") for i in range(SPEEDS.size)}
    assert late.columns[0, "A"].shape == (ROWS, KNOTS.size)
    assert "wanders within runs" in late.sentence()
    assert module.SKEW.name in OWN
    assert all(module.SKEW.gloss(p.name) for p in (mean, scatter))


def test_delays_that_are_another_one_in_each_run_have_one_column(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    late = found(monkeypatch, [noise(rng) - speed(i) * (DELAY + 1e-3 * rng.standard_normal()) for i in range(12)])
    assert late
    assert not late.wander
    assert late.columns[3, "A"].shape == (ROWS, 1)


def test_one_delay_for_all_runs_is_no_runs_own(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    assert found(monkeypatch, [noise(rng) - 30 * DELAY * speed(i) for i in range(SPEEDS.size)]) is None


def test_what_wanders_whatever_the_speed_is_no_delay(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    drifts = [noise(rng) + 3e-5 * wandering(rng) for _ in SPEEDS]
    assert found(monkeypatch, drifts) is None
    pulled = np.tile([1.0, 1.0, 4.0, 4.0, 16.0, 16.0], 2)
    springs = [noise(rng) + 3e-6 * pulled[i] * wandering(rng) for i in range(SPEEDS.size)]
    assert found(monkeypatch, springs, pulled) is None


def test_repeats_that_differ_by_noise_and_zeros_have_no_delays_of_their_own(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    assert not any(found(monkeypatch, [noise(rng) for _ in SPEEDS]) for _ in range(20))


def test_runs_too_short_to_tell_noise_from_curves_are_not_compared(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    """Of forty means two curves of thirteen knots each leave next to nothing, whatever makes the repeats differ."""
    monkeypatch.setattr(module, "TOGETHER", 30)
    delays = [DELAY + SCATTER * wandering(rng) for _ in SPEEDS]
    assert found(monkeypatch, [noise(rng) - speed(i) * delays[i] for i in range(SPEEDS.size)]) is None


def test_counts_lost_in_one_run_are_no_delay_of_every_run(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    left = [noise(rng) for _ in SPEEDS]
    left[8][ROWS // 2 :] += 15 * NOISE
    assert found(monkeypatch, left) is None
