"""Zeros of runs that follow the time are told from those that wander, step, or go with a condition."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor import offsets
from rig.analysis.tracing.residual import drifting_zeros as module
from rig.analysis.tracing.residual.drifting_zeros import DriftingZeros, drifting_zeros
from rig.analysis.tracing.selection import verdict
from rig.model.effect import MEASURED

RUNS, LASTS, EVERY = 24, 20.0, 80.0  # s
TIMES = EVERY * np.arange(RUNS) + LASTS / 2
SPEEDS = np.tile([10.0, 30.0, -20.0, 40.0], RUNS // 4)  # rad/s
WANDER, SIZE, TAU = 1e-6, 1.2e-4, 700.0  # rad, rad, s
SOFT = 1.33e-4  # rad/(N·m)


def found(
    monkeypatch: pytest.MonkeyPatch,
    zeros: Sequence[float],
    speeds: np.ndarray = SPEEDS,
    has: frozenset[str] = MEASURED,
    of_the_torque: Sequence[float] | None = None,
) -> DriftingZeros | None:
    """Of runs with those zeros [rad], every third of them unseen, and zeros of the torque sensor [N·m]."""
    runs = [
        SimpleNamespace(
            locked=False,
            has=has,
            mean_torque=0.5 * np.sign(speed),
            pieces=[
                SimpleNamespace(
                    t=np.array([t - LASTS / 2, t + LASTS / 2]),
                    omega_m=np.full(2, speed),
                    torque=np.array([-60.0, 60.0]),
                )
            ],
        )
        for t, speed in zip(TIMES, speeds, strict=True)
    ]
    rows = {(i, c) for i in range(RUNS) for c in ("A" if of_the_torque is None else "AL")}
    s: Any = SimpleNamespace(
        design=SimpleNamespace(eq=SimpleNamespace(runs=runs, rows=rows), terms=()),
        value=lambda name: {"compliance": SOFT}[name],
    )
    known = {"A": zeros, "L": of_the_torque or ()}
    for where, name in ((module, "zero"), (offsets, "offset")):
        monkeypatch.setattr(where, name, lambda _, run, channel: known[channel][run])
    unseen = range(1, RUNS, 3)
    return drifting_zeros(s, [i for i in range(RUNS) if i not in unseen], unseen)


def wander(rng: np.random.Generator) -> np.ndarray:
    return WANDER * rng.standard_normal(RUNS)


def test_zeros_that_warm_up_are_told_with_their_size_and_time(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    drift = found(monkeypatch, wander(rng) - SIZE * np.exp(-TIMES / TAU))
    assert drift
    assert abs(drift.size) == pytest.approx(SIZE * (np.exp(-TIMES[0] / TAU) - np.exp(-TIMES[-1] / TAU)), rel=0.05)
    assert drift.time_constant == pytest.approx(TAU, rel=0.25)
    assert drift.foretold > 0.98
    assert "no effect of the library" in drift.sentence()


def test_zeros_that_go_on_drifting_evenly_are_told(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    drift = found(monkeypatch, wander(rng) + 5e-8 * TIMES)
    assert drift
    assert abs(drift.size) == pytest.approx(5e-8 * np.ptp(TIMES), rel=0.1)


def test_zeros_that_wander_are_not_told(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    assert not any(found(monkeypatch, 50.0 * wander(rng)) for _ in range(100))
    walks = [np.cumsum(10.0 * wander(rng)) for _ in range(100)]
    assert sum(found(monkeypatch, walk) is not None for walk in walks) < 5


def test_zeros_that_step_once_are_another_thing(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    for at in (3, 9, 15, 21):
        assert found(monkeypatch, wander(rng) + SIZE * (np.arange(RUNS) >= at)) is None


def test_zeros_that_go_with_the_speed_are_another_thing(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    rising = np.linspace(10.0, 50.0, RUNS)  # taken in turn: by the time as well
    assert found(monkeypatch, wander(rng) + 1e-6 * rising, rising) is None


def test_without_a_torque_sensor_wind_up_shifts_a_zero_as_well(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    zeros = wander(rng) - SIZE * np.exp(-TIMES / TAU)
    assert found(monkeypatch, zeros, has=MEASURED - {"tau_l"}) is None


@pytest.mark.parametrize(("torque", "angles", "told"), [
    (0.14, 0.0, ""),  # N·m in half an hour, 3.5 arcsec of wind-up: every torque sensor does so
    (0.14, SIZE, "The zeros of the angles drift"),
    (0.75, 0.0, "The zero of the torque sensor drifts through the campaign, by 0.7"),
    (0.0, SIZE, "The zeros of the angles drift"),
])  # fmt: skip
def test_what_the_zero_of_the_torque_sensor_makes_is_no_drift_of_the_angles(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator, torque: float, angles: float, told: str
) -> None:
    zero = torque * TIMES / np.ptp(TIMES)
    zeros = wander(rng) - SOFT * zero - angles * np.exp(-TIMES / TAU)
    drift = found(monkeypatch, list(zeros), of_the_torque=list(zero + 1e-3 * rng.standard_normal(RUNS)))
    assert (drift.sentence() if drift else "").startswith(told)
    assert (drift is not None) is bool(told)


def test_what_the_balance_of_the_load_does_not_show_is_not_laid_on_the_torque_sensor(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    """Loads that are not what they are declared to be by half a newton metre hide whose zero it is."""
    zeros = wander(rng) - SIZE * np.exp(-TIMES / TAU)
    drift = found(monkeypatch, list(zeros), of_the_torque=list(0.5 * rng.standard_normal(RUNS)))
    assert drift
    assert drift.sentence().startswith("The zeros of the angles drift")


def test_a_drift_of_the_torque_sensor_is_seen_beside_friction_of_the_load_that_scatters(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    zero = 0.98 * (1 - np.exp(-TIMES / TAU))
    in_the_load = zero + 0.15 * rng.standard_normal(RUNS)
    drift = found(monkeypatch, list(wander(rng) - SOFT * zero), of_the_torque=list(in_the_load))
    assert drift
    assert drift.torque == pytest.approx(np.ptp(zero), rel=0.05)


def test_what_a_lock_test_winds_up_is_no_measure_of_a_sensor_where_runs_turn_freely() -> None:
    def run(torque: float, locked: bool) -> SimpleNamespace:
        return SimpleNamespace(has=MEASURED, locked=locked, pieces=[SimpleNamespace(torque=np.full(10, torque))])

    both: Any = SimpleNamespace(runs=[run(40.0, False), run(140.0, True)])
    alone: Any = SimpleNamespace(runs=[run(140.0, True)])
    assert module.largest_torque(both) == 40.0
    assert module.largest_torque(alone) == 140.0


@pytest.mark.parametrize(
    ("left", "names", "told"), [(1.3, (), True), (2.0, (), False), (1.3, ("cogging_torque",), False)]
)
def test_a_drift_is_told_before_next_to_nothing_that_is_left_and_not_before_more(
    monkeypatch: pytest.MonkeyPatch, left: float, names: tuple[str, ...], told: bool
) -> None:
    """What of it falls within runs is above the floor too, and lives in memory (exam 78, case 36)."""
    rest = SimpleNamespace(told_where="something is left")
    drift = SimpleNamespace(told_where="time")
    steps = {"_by_a_law": None, "_drifting": drift, "_loads_drag": None, "where_left": [], "_with_a_remainder": rest}
    for step, said in steps.items():
        monkeypatch.setattr(verdict, step, lambda *of, said=said: said)
    asked: Any = SimpleNamespace(
        p=None, s=None, names=names, loud=True, worst=(left, left), floors={}, after={}, one=1.0
    )
    assert verdict._decided(asked) is (drift if told else rest)


@pytest.mark.parametrize(("count", "told"), [(24, True), (9, False)])
def test_where_a_part_of_every_run_was_fitted_some_are_foretold_by_the_others(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator, count: int, told: bool
) -> None:
    times = 80.0 * np.arange(count)
    runs = [
        SimpleNamespace(
            locked=False, has=MEASURED, mean_torque=0.5, pieces=[SimpleNamespace(t=t + np.array([0.0, 20.0]),
                omega_m=np.full(2, v), torque=np.full(2, 0.5), tau_ext=np.zeros(2))],
        )
        for t, v in zip(times, np.resize([10.0, 30.0, -20.0, 40.0], count), strict=True)
    ]  # fmt: skip
    eq: Any = SimpleNamespace(runs=runs, rows={(i, "A") for i in range(count)})
    both = module.both_free(eq, range(count), ())
    assert (both is not None) is told
    if both is not None:
        mine, others = both
        assert sorted((*mine, *others)) == list(range(count))
        assert len(others) == count // 3
        assert min(others) > 0
        assert max(others) < count - 1
