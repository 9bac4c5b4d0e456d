"""A run without a repeat whose torque no friction, weight or spring allows is told, and none of the others."""

from __future__ import annotations

import itertools
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.runs.balance import odd_balances

NUMBERS = itertools.count()
N, RATIO, DT = 400, 50.0, 0.01
SPEEDS = (12.0, 20.0, 31.0, -20.0, -31.0)  # rad/s
TAU_C, F_CL = 0.3, 0.8  # N·m, of the motor and of the load


def run(speed: float, weight: float = 0.0, **as_read: Any) -> Any:
    """At one speed, forth and back where it is 0; `as_read` changes a torque."""
    way = np.sign(speed) * np.ones(N) if speed else np.sign(N / 2 - np.arange(N) - 0.5)
    omega = way * (abs(speed) or 1.0)
    tau_l = F_CL * way - weight
    return recorded({"tau_m": TAU_C * way + tau_l / RATIO, "tau_l": tau_l}, omega, weight, False, as_read)


def lock(slope: float = 3.0, **as_read: Any) -> Any:
    """Wound up and let go."""
    theta = np.sin(np.linspace(0.0, 2 * np.pi, N))
    torques = {"tau_m": slope * theta, "tau_l": 0.5 * RATIO * slope * theta}
    return recorded(torques, np.gradient(theta, DT), 0.0, True, as_read)


def recorded(torques: dict[str, Any], omega: Any, weight: float, locked: bool, as_read: dict[str, Any]) -> Any:
    torques |= {name: change(torques[name]) for name, change in as_read.items()}
    piece = SimpleNamespace(
        omega_m=omega,
        omega_l=0.0 * omega if locked else omega / RATIO,
        theta_m=np.cumsum(omega) * DT,
        way=np.sign(omega),
        dt=DT,
        tau_ext=np.full(N, weight),
        gear=SimpleNamespace(J_m=1e-3, J_l=0.3),
        **torques,
    )
    return SimpleNamespace(
        name=f"run {next(NUMBERS)}",
        locked=locked,
        procedure="stiffness_lock" if locked else "constant_torque",
        ratio=RATIO,
        has={"tau_m", "tau_l"},
        pieces=(piece,),
        load_stated=True,
    )


def campaign() -> list[Any]:
    return [*(run(speed) for speed in SPEEDS), run(0.0), run(0.0, 5.0), run(0.0, -20.0), run(12.0, 20.0)]


def negated(x: Any) -> Any:
    return -x


def in_mNm(x: Any) -> Any:
    return 1000 * x


def test_runs_that_read_as_they_do_are_not_odd_under_any_weight_or_lock() -> None:
    assert odd_balances([*campaign(), lock(), lock(2.5), run(31.0, -40.0)]) == {}


@pytest.mark.parametrize(
    ("odd", "words"),
    [
        (run(25.0, tau_m=negated), "what its τ_m puts into friction is -0.3"),
        (run(0.0, 10.0, tau_m=negated), "it has the other sign than theirs, or what hangs on the output has"),
        (run(25.0, tau_m=in_mNm), "as if in another unit"),
        (run(25.0, tau_l=in_mNm), "its τ_l is 800 N·m in the mean, N·τ_m and the weight come to 15.8 N·m"),
        (run(0.0, 10.0, tau_l=negated), "its τ_l is 10 N·m in the mean, expected -10 N·m against the declared weight"),
        (run(25.0, tau_l=negated), "its τ_l says that the load rubs with -0.8 N·m"),
    ],
)
def test_the_one_that_is_off_is_told_without_a_repeat(odd: Any, words: str) -> None:
    ((name, said),) = odd_balances([*campaign(), odd]).items()
    assert name == odd.name
    assert words in said


@pytest.mark.parametrize("weight", [-10.0, 10.0])
def test_a_weight_in_another_unit_is_told_as_one_and_not_as_friction(weight: float) -> None:
    odd = run(25.0, weight)
    odd.pieces[0].tau_ext = 1000 * odd.pieces[0].tau_ext
    shown = weight - F_CL
    said = (
        f"its manifest says that {1000 * weight:.3g} N·m hang on the output, its τ_l shows {shown:.3g} N·m: one of them"
    )
    assert odd_balances([*campaign(), odd]) == {odd.name: f"{said} is in another unit"}


@pytest.mark.parametrize("channel", ["tau_m", "tau_l"])
@pytest.mark.parametrize(("change", "words"), [(negated, "the other sign"), (in_mNm, "as if in another unit")])
def test_a_lock_test_is_told_beside_others_of_any_travel(channel: str, change: Any, words: str) -> None:
    odd = lock(2.8, **{channel: change})
    ((name, said),) = odd_balances([lock(), lock(2.5), odd]).items()
    assert name == odd.name
    assert words in said


def test_the_only_lock_test_is_told_by_its_other_units() -> None:
    odd = lock(tau_l=in_mNm)
    assert "expected 0.05 to 5" in odd_balances([odd])[odd.name]
    assert odd_balances([lock()]) == {}


def test_where_most_are_odd_none_is() -> None:
    assert odd_balances([run(speed, tau_m=negated) for speed in SPEEDS]) == {}


def test_a_run_that_slows_down_owes_its_torque_to_inertias_nobody_knows() -> None:
    coast = run(31.0, tau_m=lambda x: -0.01 + 0 * x)
    coast.pieces[0].omega_m *= np.linspace(1.0, 0.0, N)
    coast.pieces[0].omega_l *= np.linspace(1.0, 0.0, N)
    assert odd_balances([*campaign(), coast]) == {}
