"""An inertia under a position loop whose torque is told half a cycle late."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from rig.analysis.tracing.fit.channels import BASELINE, INDEX
from rig.analysis.tracing.fit.equations import Bare, Equations, Noise
from rig.analysis.tracing.fit.late_reading import NAME, beside_a_late_reading
from rig.analysis.tracing.fit.model import Design, Part, Solution, fit, normal
from rig.analysis.tracing.fit.parameters import baseline, inertias_by_what_returns
from rig.analysis.tracing.runs.look import Look

J_M, B_M = 1.5e-3, 3e-3  # kg·m², N·m·s/rad
GAIN = 0.11  # N·m·s/rad, of the loop
LATE = 5e-4  # s
T = np.arange(0.0, 8.0, 4e-3)
ROWS = slice(10, -10)
BAND = 2.0  # rows, of a smoother that leaves what is below 20 Hz
AT = np.array([INDEX["J_m"], INDEX["B_m"]])


class Slopes:
    """What a run's smoother is asked for, without any smoothing."""

    def of(self, channel: str) -> Slopes:
        return self

    def __call__(self, x: np.ndarray, order: int = 0) -> np.ndarray:
        return np.gradient(x, T) if order else x


def solved(late: float, gain: float = GAIN, noise: float = 1e-3, runs: int = 8) -> Solution:
    """Runs at as many speeds, whose motor a loop holds back by `gain` times its speed, 2.5 ms behind; its torque is
    read `late`, with `noise` N·m that a smoother leaves. All else that drives it is read at once."""
    rng, made = np.random.default_rng(1), list[Any]()
    y: dict[Any, Any] = {}
    parts: dict[Any, Any] = {}
    rows: dict[Any, Any] = {}
    for run in range(runs):
        speed = 10.0 + 4.0 * run  # rad/s
        waves = [(n * speed, rng.uniform(0, 6), 2.0 / n) for n in (1, 2, 3)]

        def omega(t: np.ndarray, speed: float = speed, waves: list[Any] = waves) -> np.ndarray:
            return np.asarray(speed + sum(size * np.sin(w * t + phase) for w, phase, size in waves))

        def loop(t: np.ndarray, speed: float = speed, omega: Any = omega) -> np.ndarray:
            return np.asarray(gain * (speed - omega(t - 2.5e-3)))

        alpha = np.gradient(omega(T), T)
        white = gaussian_filter1d(rng.standard_normal(T.size), BAND)
        acts, read = loop(T), loop(T - late) + noise * white / white.std()
        shaft = J_M * alpha + B_M * omega(T) - acts  # read at once
        y[run, "M"] = (read + shaft)[ROWS]
        parts[run, "M"] = (Part(Bare(np.stack([alpha, omega(T)], 1)[ROWS]), AT, None),)
        keep = np.zeros(T.size, bool)
        keep[ROWS] = True
        rows[run, "M"] = SimpleNamespace(theta_m=speed * T[ROWS], keep=keep, own=np.zeros((0, 0)), y=y[run, "M"])
        piece = SimpleNamespace(tau_m=read, gear=SimpleNamespace(K=7160.0))
        made.append(
            SimpleNamespace(
                locked=False, look=Look(), pieces=(piece,), has=frozenset({"t", "tau_m"}), smoother=Slopes()
            )
        )
    eq = Equations(tuple(made), rows, Noise({"M": 1e-3}, {"M": 1.0}, {"M": 1.0}))
    size = len(BASELINE)
    d = Design(eq, (), (), y, {}, parts, np.zeros((size, size)), np.zeros(size))
    gram, right, _ = normal(d, {key: part[0] for key, part in parts.items()})
    return fit(Design(eq, (), (), y, {}, parts, gram, right))


def test_an_inertia_is_right_though_the_torque_is_read_late() -> None:
    s = solved(LATE)
    assert abs(s.value("J_m") / J_M - 1) > 0.01  # what the delay makes of it
    late, _ = beside_a_late_reading(s)
    assert late.value("J_m") == pytest.approx(J_M, rel=0.005)
    assert late.value(NAME) == pytest.approx(LATE, rel=0.1)


def test_it_is_told_with_an_interval_that_holds_it() -> None:
    told = {p.name: p for p in inertias_by_what_returns(solved(LATE), ())}
    assert told["J_m"].ci95[0] < J_M < told["J_m"].ci95[1]
    assert told[NAME].ci95[0] < LATE < told[NAME].ci95[1]


@pytest.mark.parametrize("how", [{"late": 0.0}, {"late": LATE, "gain": 0.0}, {"late": 4e-3}], ids=str)
def test_nothing_is_taken_off_where_nothing_is_late_or_more_than_a_cycle(how: dict[str, Any]) -> None:
    s = solved(**how)
    late, _ = beside_a_late_reading(s)
    assert late is s


def test_where_noise_hides_the_delay_the_inertia_is_as_unsure_as_it_would_move() -> None:
    s = solved(LATE, noise=1.5e-3, runs=3)
    late, more = beside_a_late_reading(s)
    assert late is s
    (told,) = (p for p in inertias_by_what_returns(s, ()) if p.name == "J_m")
    (plain,) = (p for p in baseline(s) if p.name == "J_m")
    assert not plain.ci95[0] < J_M < plain.ci95[1]
    assert told.ci95[0] < 1.002 * J_M  # noise of the torque's slope makes its delay seem smaller
    assert told.ci95[1] > J_M
    assert told.value == pytest.approx(plain.value, rel=1e-3)
    assert more[INDEX[NAME]].max() == 0
