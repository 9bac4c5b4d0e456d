"""A spring that is not linear is told from a torque sensor that is not by the weights that were declared."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.residual import bent_sensor as module
from rig.analysis.tracing.residual.bent_sensor import is_the_sensors
from rig.model.effect import MEASURED

WEIGHTS = np.repeat([0.0, -2.5, -5.0, -10.0, -20.0, -40.0], 2)  # N·m
SOFT, WANDER, OF_THE_SENSOR = 1.33e-4, 1e-6, 0.005  # rad/(N·m), rad, N·m
OFF = -0.17 * np.tanh(-WEIGHTS / 6.0)  # N·m, what the sensor reads too little
SPRING = {"nonlinear_stiffness"}


def told(
    monkeypatch: pytest.MonkeyPatch,
    angle: np.ndarray,
    torque: np.ndarray,
    names: set[str] = SPRING,
    weights: np.ndarray = WEIGHTS,
    wave: np.ndarray | None = None,
) -> bool:
    """Whether it is the sensor's, of runs with those zeros of the wind-up [rad] and of the load's balance [N·m]."""
    runs = [
        SimpleNamespace(
            locked=False,
            load_stated=True,
            has=MEASURED,
            mean_torque=-w,
            pieces=[SimpleNamespace(tau_ext=np.full(3, w))],
        )
        for w in weights
    ]
    rows = {(i, c) for i in range(len(runs)) for c in "AL"}
    means = np.zeros(weights.size) if wave is None else wave
    term = SimpleNamespace(name="torque_sensor_crosstalk")
    made = {"A": -SOFT, "L": 1.0}
    eq = SimpleNamespace(
        runs=runs,
        rows=rows,
        noise=SimpleNamespace(local={"A": WANDER}),
        term=lambda run, _: {c: np.full((5, 1), of * means[run]) for c, of in made.items()},
    )
    design = SimpleNamespace(eq=eq, terms=(term,), place=lambda i: slice(0, 1))
    s: Any = SimpleNamespace(design=design, x=np.ones(1), value=lambda name: {"compliance": SOFT}[name])
    monkeypatch.setattr(module, "offset", lambda _, run, channel: {"A": angle, "L": torque}[channel][run])
    return is_the_sensors(s, names, range(len(runs)))


def test_what_the_load_feels_as_well_is_the_sensors(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    angle = -SOFT * OFF + WANDER * rng.standard_normal(WEIGHTS.size)
    torque = OFF + OF_THE_SENSOR * rng.standard_normal(WEIGHTS.size)
    assert told(monkeypatch, angle, torque)
    assert told(monkeypatch, angle, torque + 0.01 * WEIGHTS)  # weights are known to a per cent
    assert not told(monkeypatch, angle, torque, {"hysteretic_stiffness"})
    assert not told(monkeypatch, angle[:4], torque[:4], weights=WEIGHTS[:4])  # a line goes through two weights


def test_what_the_load_does_not_feel_is_the_springs(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    angle = -SOFT * OFF + WANDER * rng.standard_normal(WEIGHTS.size)
    assert not told(monkeypatch, angle, OF_THE_SENSOR * rng.standard_normal(WEIGHTS.size))


def test_zeros_of_a_sensor_that_wander_are_no_curve(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    wander = 0.015 * rng.standard_normal(WEIGHTS.size)
    assert not told(monkeypatch, -SOFT * wander, wander)


def test_the_mean_of_a_wave_in_runs_that_go_round_but_in_part_is_no_curve(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    """Runs under load go over a part of a turn, those without any number of turns."""
    wave = np.where(WEIGHTS < 0, 0.3, 0.0)
    noise = rng.standard_normal((2, WEIGHTS.size))
    angle, torque = WANDER * noise[0] - SOFT * wave, OF_THE_SENSOR * noise[1] + wave
    assert told(monkeypatch, angle, torque)
    assert not told(monkeypatch, angle, torque, wave=wave)
