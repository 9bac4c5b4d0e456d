"""A run whose torque is read otherwise than that of its repeats is left out, and said to be; the others stay."""

from __future__ import annotations

import itertools
import re
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.runs import odd_torques as module
from rig.analysis.tracing.runs.odd_torques import odd_torques

NUMBERS = itertools.count()
N, SPEEDS = 400, (12.0, 20.0, -20.0, 31.0)


@pytest.fixture(autouse=True)
def _said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "moved_alike", lambda a, b: bool(a.said == b.said))
    monkeypatch.setattr(module, "alike", lambda a, b: bool(a.said == b.said and abs(a.mean_torque - b.mean_torque) < 1))


def run(rng: np.random.Generator, speed: float, locked: bool = False, **as_read: Any) -> Any:
    """One at a steady speed [rad/s], friction of the motor and of the load; `as_read` changes a torque."""
    torques = {
        "tau_m": (0.3 + 2e-3 * abs(speed)) * np.sign(speed) + 0.02 * rng.standard_normal(N),
        "tau_l": 0.5 * np.sign(speed) + 0.1 * rng.standard_normal(N),
    }
    torques |= {name: change(torques[name]) for name, change in as_read.items()}
    piece = SimpleNamespace(omega_m=np.full(N, speed), **torques)
    return SimpleNamespace(
        name=f"run {next(NUMBERS)}",
        said=speed,
        locked=locked,
        procedure="constant_torque",
        has={"tau_m", "tau_l"},
        pieces=(piece,),
        load_stated=True,
        mean_torque=float(torques["tau_l"].mean()),
    )


def campaign(rng: np.random.Generator) -> list[Any]:
    return [run(rng, speed) for speed in SPEEDS for _ in range(2)]


@pytest.mark.parametrize(
    ("as_read", "words"),
    [
        ({"tau_m": lambda x: 1000 * x}, "its τ_m is .* times that of its repeats"),
        ({"tau_l": lambda x: x / 1000}, "its τ_l is one .*th of that of its repeats"),
        ({"tau_m": lambda x: -x}, "its τ_m has the other sign"),
        ({"tau_l": lambda x: 0 * x + 1.5}, "its τ_l is 1.5 N·m throughout"),
    ],
)
def test_the_one_that_is_off_is_told_and_none_of_the_others(
    rng: np.random.Generator, as_read: dict[str, Any], words: str
) -> None:
    others = campaign(rng)
    odd = run(rng, SPEEDS[0], **as_read)
    runs = [*others, odd]
    ((name, said),) = odd_torques(runs).items()
    assert name == odd.name
    assert re.search(words, said)


def test_runs_that_read_as_they_do_are_not_odd_whatever_load_or_lock(rng: np.random.Generator) -> None:
    loaded = [run(rng, speed, tau_l=lambda x: x + 40.0, tau_m=lambda x: x + 0.8) for speed in (1.0, 1.0)]
    locked = [run(rng, 0.1, locked=True, tau_l=lambda x: 300 * x) for _ in range(2)]
    runs = [*campaign(rng), *loaded, *locked]
    assert odd_torques(runs) == {}


def test_without_a_repeat_a_size_or_a_sign_tells_nothing(rng: np.random.Generator) -> None:
    runs = [run(rng, speed) for speed in SPEEDS]
    odd = run(rng, 5.0, tau_m=lambda x: -1000 * x)
    assert odd_torques([*runs, odd]) == {}


def test_a_shaft_torque_in_another_unit_makes_no_other_weight_of_it_where_the_weight_is_said(
    rng: np.random.Generator,
) -> None:
    odd = run(rng, SPEEDS[0], tau_l=lambda x: 1000 * x)
    assert list(odd_torques([*campaign(rng), odd])) == [odd.name]
    odd.load_stated = False  # then it may be one that nobody wrote down
    assert odd_torques([*campaign(rng), odd]) == {}


def test_power_that_is_little_of_torque_and_speed_has_no_sign(rng: np.random.Generator) -> None:
    loaded = [run(rng, SPEEDS[0], tau_l=lambda x, by=by: 0.01 * by + 20.0 * rng.standard_normal(N)) for by in (1, -1)]
    assert odd_torques([*campaign(rng), *loaded]) == {}


def test_where_most_runs_read_nothing_none_is_odd_for_it(rng: np.random.Generator) -> None:
    runs = [run(rng, speed, tau_l=lambda x: 0 * x) for speed in SPEEDS]
    assert odd_torques(runs) == {}


def test_a_run_that_reads_each_torque_in_the_others_place_is_told_and_its_repeat_is_not(
    rng: np.random.Generator,
) -> None:
    runs = [run(rng, speed, tau_l=lambda x: 2 * x) for speed in SPEEDS for _ in range(2)]
    piece = runs[3].pieces[0]
    piece.tau_m, piece.tau_l = piece.tau_l, piece.tau_m
    assert odd_torques(runs) == {
        runs[3].name: "its τ_m is what its repeats read in τ_l, and its τ_l what they read in τ_m: exchanged"
    }
