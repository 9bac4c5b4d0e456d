"""What lock tests and friction runs put into a gear file beside the parameters."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rig.analysis.findings.result import Estimate, Result, Verdict
from rig.analysis.friction.characteristics import FIGURES, characteristics
from rig.model.gearfile import CHARACTERISTICS


def result(*figures: Estimate) -> Result:
    return Result("stiffness_lock", Verdict.MEASURED, "", estimates=figures)


def figure(name: str, value: float, half: float, unit: str) -> Estimate:
    return Estimate(name, f"label of {name}", value, unit, (value - half, value + half), "")


def test_figures_come_in_si_with_the_runs_that_showed_them() -> None:
    found = characteristics([
        ("lock_1", result(figure("hysteresis_loss", 0.5, 0.1, "arcmin"), figure("stiffness_K1", 7e3, 70.0, "N·m/rad"))),
        ("friction_1", result(figure("breakaway", 0.42, 0.02, "N·m"))),
    ])  # fmt: skip
    assert set(found) == {"tau_break", "hysteresis_loss", "K1"}
    loss = found["hysteresis_loss"]
    assert (loss.value, loss.half) == pytest.approx((np.radians(0.5 / 60), np.radians(0.1 / 60)))
    assert loss.runs == ("lock_1",)
    assert found["K1"].note == "label of stiffness_K1"
    assert found["tau_break"].value == 0.42


def test_several_runs_share_their_sensors_and_add_how_they_scatter() -> None:
    alike = characteristics([(f"l{k}", result(figure("stiffness_K1", 7000.0, 70.0, "N·m/rad"))) for k in range(4)])[
        "K1"
    ]
    apart = characteristics(
        [(f"l{k}", result(figure("stiffness_K1", 7000.0 + 100 * k, 70.0, "N·m/rad"))) for k in range(4)]
    )["K1"]
    assert alike.half == pytest.approx(70.0), "four runs with one sensor know its gain no better than one"
    assert apart.value == pytest.approx(7150.0)
    assert apart.half == pytest.approx(np.hypot(70.0, 3.182 * np.std(100 * np.arange(4), ddof=1) / 2))


def test_a_run_that_knows_next_to_nothing_beside_another_is_left_out() -> None:
    K1 = characteristics([
        ("with a slow run", result(figure("stiffness_K1", 7200.0, 18.0, "N·m/rad"))),
        ("without", result(figure("stiffness_K1", 6500.0, 1400.0, "N·m/rad"))),
    ])["K1"]  # fmt: skip
    assert (K1.value, K1.half) == pytest.approx((7200.0, 18.0))
    assert K1.runs == ("with a slow run",)


def test_figures_over_other_torques_are_not_averaged() -> None:
    near, next_to_it, far = (
        replace(figure("stiffness_K1", K, half, "N·m/rad"), over=(0.0, T))
        for K, half, T in ((7000.0, 18.0, 30.0), (7020.0, 18.0, 31.0), (5000.0, 20.0, 10.0))
    )
    K1 = characteristics([("lock_60_1", result(near)), ("lock_60_2", result(next_to_it)), ("lock_20", result(far))])[
        "K1"
    ]
    assert K1.value == pytest.approx(7010.0)
    assert K1.runs == ("lock_60_1", "lock_60_2")


def test_a_figure_without_an_interval_is_listed_without_one() -> None:
    made = replace(figure("lost_motion", 6.8, 0.0, "arcmin"), ci95=(float("nan"), float("nan")))
    assert characteristics([("lock", result(made))])["lost_motion"].value == pytest.approx(np.radians(6.8 / 60))


def test_nothing_measured_is_nothing_listed() -> None:
    assert characteristics([("slow", result())]) == {}
    assert FIGURES.keys() == CHARACTERISTICS.keys(), "every name has its unit in the gear file"
