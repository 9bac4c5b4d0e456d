"""Hysteresis, what is viscous in it, energy, creep."""

from __future__ import annotations

import pytest

from rig.analysis import analyse
from rig.analysis.findings.result import Verdict
from rig.core.units import ARCMIN
from tests.analysis.stiffness.plant import K, LockedGear
from tests.analysis.stiffness.test_spring import SLIP, bent, figures
from tests.analysis.synthetic import MadeRun

FORCE = sum(most for _, most in SLIP)


@pytest.mark.slow
def test_the_hysteresis_loss_is_the_gap_the_slipping_elements_leave() -> None:
    found = figures(analyse(LockedGear(slip=SLIP).run()))["hysteresis_loss"]
    true = 2 * FORCE / K / ARCMIN
    assert abs(found.value / true - 1) < 0.05
    assert found.ci95[0] < true < found.ci95[1]


@pytest.mark.slow
def test_with_a_bent_spring_the_gap_is_that_over_its_slope_at_zero() -> None:
    found = figures(analyse(bent(slip=SLIP).run()))["hysteresis_loss"]
    assert abs(found.value / (2 * FORCE / 5000.0 / ARCMIN) - 1) < 0.05


@pytest.mark.slow
def test_the_energy_per_cycle_is_what_the_elements_lose() -> None:
    gear = LockedGear(slip=SLIP)
    true = sum(4 * most * (gear.reach - most / stiffness) for stiffness, most in SLIP)
    assert abs(figures(analyse(gear.run()))["hysteresis_energy"].value / (true * 1e3) - 1) < 0.05


@pytest.mark.slow
def test_hysteresis_is_as_wide_at_any_rate() -> None:
    result = analyse(LockedGear(slip=SLIP).run())
    found = figures(result)
    assert abs(found["loop_hysteretic"].value / FORCE - 1) < 0.03
    assert found["loop_viscous"].ci95[0] < 0 < found["loop_viscous"].ci95[1]
    assert "The loop is hysteretic:" in found["loop_viscous"].how


@pytest.mark.slow
def test_a_viscous_loop_grows_with_the_rate() -> None:
    found = figures(analyse(LockedGear(drag=4000.0).run()))
    assert abs(found["loop_viscous"].value / 4000.0 - 1) < 0.05
    assert found["loop_hysteretic"].ci95[0] < 0 < found["loop_hysteretic"].ci95[1]
    assert "The loop is viscous:" in found["loop_viscous"].how


@pytest.mark.slow
def test_both_together_are_told_apart() -> None:
    found = figures(analyse(LockedGear(slip=SLIP, drag=2000.0).run(seed=2)))
    assert abs(found["loop_viscous"].value / 2000.0 - 1) < 0.1
    assert abs(found["loop_hysteretic"].value / FORCE - 1) < 0.05
    assert "hysteretic and viscous" in found["loop_viscous"].how


@pytest.mark.slow
def test_one_rate_tells_neither_from_the_other_and_says_so() -> None:
    result = analyse(LockedGear(slip=SLIP, rates=(1.0,)).run())
    assert "loop_viscous" not in figures(result)
    assert any("ramps have one rate" in s for s in result.cannot)


@pytest.mark.slow
def test_an_elastic_gear_has_no_loop_and_the_headline_says_below_what() -> None:
    result = analyse(LockedGear().run())
    assert abs(figures(result)["hysteresis_loss"].value) < 0.01
    assert "not told from none (below 0.0" in result.sentence


@pytest.mark.slow
def test_creep_at_the_holds_is_given_per_decade() -> None:
    found = figures(analyse(LockedGear(creep=150.0).run()))["creep_per_decade"]
    true = 100 * 150.0 / (K + 2 * 150.0)  # the chain's two elements slower than a hold still carry
    assert abs(found.value / true - 1) < 0.3
    none = figures(analyse(LockedGear().run()))["creep_per_decade"]
    assert none.ci95[0] < 0 < none.ci95[1]


@pytest.mark.slow
def test_a_sensor_offset_moves_no_figure() -> None:
    a, b = (figures(analyse(LockedGear(slip=SLIP, zero=z).run())) for z in (0.0, 0.3))
    for name in ("torsional_stiffness", "hysteresis_loss", "loop_hysteretic"):
        assert abs(a[name].value / b[name].value - 1) < 0.002, name


def test_a_sensor_of_the_wrong_sign_is_rejected() -> None:
    run = LockedGear().run()
    turned = analyse(MadeRun({**run.columns, "tau_l": -run.columns["tau_l"]}, run.manifest))
    assert turned.verdict is Verdict.INCONCLUSIVE
    assert "wrong sign" in turned.sentence
    assert "torsional_stiffness" not in figures(turned)


@pytest.mark.slow
def test_where_the_motor_sticks_and_slips_a_viscous_loop_bends_no_spring() -> None:
    gear = LockedGear(drag=400.0, rate=500.0, slips=24)  # 3.5 N·m while it slips, 0.04 N·m in the mean
    found = figures(analyse(gear.run()))
    for name in ("torsional_stiffness", "stiffness_K1", "stiffness_K2", "stiffness_K3"):
        assert abs(found[name].value / K - 1) < 0.02, name
