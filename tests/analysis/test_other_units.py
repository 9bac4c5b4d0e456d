"""Runs in another unit than they say pass no limit."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rig.analysis import analyse
from rig.analysis.findings.result import Verdict
from rig.analysis.motion.degrees import DEGREES, Turning, come_again_in_degrees
from rig.runfile.run import Run
from tests.analysis.synthetic import MadeRun

COUNT = 2 * np.pi / 65_536


def changed(run: Run, limits: dict[str, dict[str, float]], **times: float) -> MadeRun:
    """The run with some channels so many times as large, held to limits."""
    names = ("t", "theta_m", "theta_l", "tau_m", "tau_l")
    columns = {name: x * times.get(name, 1.0) for name in names if (x := run.column(name)) is not None}
    return MadeRun(columns, {**run.manifest, "limits": limits})


def test_angles_in_degrees_meet_no_limit(shared: Path) -> None:
    run = Run.open(shared / "cases" / "open-1" / "slow_ke_1")
    limits = {"kinematic_error_peak_to_peak": {"upper": 200.0}}
    assert analyse(changed(run, limits)).verdict is Verdict.PASS
    in_degrees = analyse(changed(run, limits, theta_m=DEGREES, theta_l=DEGREES))
    assert (in_degrees.verdict, in_degrees.rejected) == (Verdict.INCONCLUSIVE, True)
    assert "57.3 times the declared count" in in_degrees.sentence
    assert "kinematic_error_peak_to_peak" not in {e.name for e in in_degrees.estimates}


def test_a_slow_run_without_a_load_angle_is_no_pass(shared: Path) -> None:
    run = Run.open(shared / "cases" / "open-1" / "slow_ke_1")
    without = analyse(changed(run, {}, theta_l=np.nan))
    assert (without.verdict, without.rejected) == (Verdict.INCONCLUSIVE, False)
    assert "theta_l has no reading" in without.sentence


def test_a_torque_in_another_unit_meets_no_limit_of_the_stiffness(shared: Path) -> None:
    run = Run.open(shared / "cases" / "open-1" / "lock_60_1")
    limits = {"torsional_stiffness": {"lower": 5000.0}}
    assert analyse(changed(run, limits)).verdict is Verdict.PASS
    in_mNm = analyse(changed(run, limits, tau_l=1000.0))
    assert in_mNm.verdict is Verdict.INCONCLUSIVE
    assert any("times the 7.16e+03 declared" in said for said in (in_mNm.sentence, *in_mNm.cannot))


@pytest.mark.parametrize("name", ["slow_ke_1", "speed_200rpm_1"])
def test_a_torque_that_would_wind_the_gear_up_further_than_it_is_may_be_in_another_unit(
    shared: Path, name: str
) -> None:
    run = Run.open(shared / "cases" / "open-1" / name)

    def told(times: float) -> list[str]:
        return [said for said in analyse(changed(run, {}, tau_l=times)).cannot if said.startswith("The unit of tau_l")]

    assert not told(1.0)
    (said,) = told(1000.0)
    assert "would wind a gear of the declared K = " in said


def test_the_unit_of_an_angle_is_told_by_its_step_by_the_declared_speed_and_by_what_no_motor_reaches() -> None:
    right = Turning(step=COUNT, count=COUNT, rpm=300.0, said_rpm=300.0, ratio=50.0)
    assert right.in_degrees is None
    assert "57.3 times the declared count" in (replace(right, step=COUNT * DEGREES).in_degrees or "")
    coarse = replace(right, step=0.0)
    assert "57.3 times the declared speed_rpm" in (replace(coarse, rpm=300.0 * DEGREES).in_degrees or "")
    assert "expected below 15000 rpm" in (replace(coarse, said_rpm=0.0, rpm=22_918.0).in_degrees or "")
    assert replace(coarse, rpm=None).in_degrees is None


def test_angles_in_degrees_are_told_by_their_waves_where_nobody_says_a_count(shared: Path) -> None:
    run = Run.open(shared / "cases" / "open-1" / "slow_ke_1")
    foreign = MadeRun(
        {n: x * DEGREES for n in ("theta_m", "theta_l") if (x := run.column(n)) is not None} | {"t": run.column("t")},
        {"schema": "hdrig.run/1", "procedure": "other", "gear": {"ratio": 50}},
    )
    found = analyse(foreign)
    assert found.verdict is Verdict.INCONCLUSIVE
    assert "both angles seem to be in degrees" in found.sentence


def test_an_eccentric_encoder_of_the_output_is_no_angle_in_degrees() -> None:
    """Ten turns of the output, 3 mrad once in each of them and 40 µrad twice in each of the motor."""
    theta_m = np.linspace(0.0, 2 * np.pi * 500, 100_000)
    theta_l = theta_m / 50 - 4e-5 * np.cos(2 * theta_m)
    assert come_again_in_degrees(theta_m, theta_l + 3e-3 * np.cos(theta_m / 50), 50.0) is None
    assert come_again_in_degrees(theta_m * DEGREES, theta_l * DEGREES, 50.0)
    for turns, told in ((3.0, False), (4.0, True)):
        few = slice(0, int(turns * 200))
        assert bool(come_again_in_degrees(theta_m[few] * DEGREES, theta_l[few] * DEGREES, 50.0)) is told
    short = slice(0, int(4.6 * 50 * 200))  # of the output 4.6 turns, in which its order is least unlike one of degrees
    assert come_again_in_degrees(theta_m[short], theta_l[short] + 3e-3 * np.cos(theta_m[short] / 50), 50.0) is None


def test_one_angle_in_degrees_is_not_called_both() -> None:
    theta_m = np.linspace(0.0, 2 * np.pi * 8, 8000)
    theta_l = theta_m / 50 - 4e-5 * np.cos(2 * theta_m)
    assert come_again_in_degrees(theta_m * DEGREES, theta_l, 50.0) is None


@pytest.mark.parametrize(("name", "factor"), [("tau_m", 1000.0), ("t", 1000.0)])
def test_what_no_gear_has_is_told_of_a_foreign_run(name: str, factor: float, shared: Path) -> None:
    run = Run.open(shared / "cases" / "open-1" / "load_40nm_1")
    columns = {n: x for n in ("t", "theta_m", "theta_l", "tau_m", "tau_l") if (x := run.column(n)) is not None}
    about = {"schema": "hdrig.run/1", "procedure": "other", "gear": {"ratio": 50}}
    found = analyse(MadeRun(columns | {name: columns[name] * factor}, about))
    assert [s for s in found.cannot if s.startswith(f"The unit of {name} may be another one: ")]
    assert not [s for s in analyse(MadeRun(columns, about)).cannot if "may be another one" in s]
