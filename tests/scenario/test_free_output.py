"""The free-output experiments on the twin, end to end, against what its plant really does."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rig.analysis import analyse
from rig.analysis.across_runs.sentinel import compare
from rig.analysis.findings.result import Estimate, Result
from rig.cli import main
from rig.procedures.coast_down import CoastDown
from rig.procedures.constant_torque import ConstantTorque
from rig.procedures.full_turn import FullTurn
from rig.procedures.held_standstill import HeldStandstill
from rig.procedures.kinematic_error import KinematicError
from rig.procedures.sentinel import Sentinel
from rig.procedures.speed_convergence import SpeedConvergence
from rig.procedures.standstill import Standstill
from tests.analysis.recorded import Rig, Taken
from tests.analysis.synthetic import ARCSEC, TURN

pytestmark = pytest.mark.xdist_group("free output")  # what the module makes is made once, not for every worker

SHORT = ["--with", "cycles=1", "--with", "amplitude_deg=720", "--with", "frequency=0.02"]  # 9.6 rpm, 51 s


def figure(result: Result, name: str) -> Estimate:
    return next(e for e in result.estimates if e.name == name)


@pytest.fixture(scope="module")
def campaign() -> tuple[Rig, Taken]:
    """A twin and its slow run; what is run on it afterwards counts from the same zero."""
    rig = Rig()
    return rig, rig.run(KinematicError(cycles=1.0))


def true_flexible(taken: Taken, orders: int = 15) -> Any:
    """Amplitudes of θ̃_s = −φ of the plant over the measured turns, arcsec."""
    found, columns = taken.ending.finding, taken.run.columns
    rows = (columns["t"] >= found.begin) & (columns["t"] <= found.end)
    theta, n = columns["theta_m"][rows], np.arange(1, orders + 1)
    angle = np.multiply.outer(theta, n)
    design = np.column_stack([np.ones(theta.size), np.cos(angle), np.sin(angle)])
    c = np.linalg.lstsq(design, -taken.phi[rows] * ARCSEC, rcond=None)[0]
    return np.hypot(c[1 : orders + 1], c[orders + 1 :])


@pytest.mark.slow
@pytest.mark.parametrize("speed_rpm", [310.0, *(pytest.param(s, marks=pytest.mark.long) for s in (500.0, -300.0))])
def test_the_flexible_part_at_speed_is_that_of_the_plant_and_of_linear_theory(
    campaign: tuple[Rig, Taken], speed_rpm: float
) -> None:
    rig, slow = campaign
    fast = rig.run(ConstantTorque(speed_rpm=speed_rpm))
    result = analyse(fast.run, slow.run)
    assert "from one zero" in next(c for c in result.checks if c.name == "alignment").sentence
    rows, truth = result.tables["decomposition"], true_flexible(fast)
    inside = [float(r["flexible_lo"]) <= true <= float(r["flexible_hi"]) for r, true in zip(rows, truth, strict=True)]
    assert sum(inside) >= 13, "95 % of 15 orders"
    for n, within in ((2, 0.01), (4, 0.03)):
        row = rows[n - 1]
        assert row["gain"] == pytest.approx(row["gain_predicted"], rel=within), f"order {n}"
    revolutions = figure(result, "revolutions_forward").value + figure(result, "revolutions_reverse").value
    assert revolutions == 60


@pytest.mark.long
def test_the_slow_run_beside_is_taken_by_itself_and_one_of_another_power_up_is_turned(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    assert main(["run", "kinematic-error", "--out", str(here), *SHORT]) == 0
    assert main(["run", "kinematic-error", "--out", str(there), "--seed", "7", *SHORT]) == 0
    assert main(["run", "constant-torque", "--out", str(here), "--with", "revolutions=30"]) == 0
    fast, slow = (next(r.rglob(f"*{word}*/manifest.json")).parent for r, word in ((here, "constant"), (there, "kinem")))
    beside = json.loads((fast / "result.json").read_text())
    capsys.readouterr()
    assert main(["analyse", str(fast), "--reference", str(slow), "--out", str(tmp_path / "again")]) == 0
    assert "θ̃_s, peak to peak" in capsys.readouterr().out
    turned = json.loads(next((tmp_path / "again").rglob("result.json")).read_text())
    for name in ("flexible_amplitude_2", "flexible_amplitude_4", "flexible_peak_to_peak"):
        one, other = beside["estimates"][name], turned["estimates"][name]
        assert one["ci95"][0] <= other["ci95"][1], name
        assert other["ci95"][0] <= one["ci95"][1], name
    assert abs(turned["estimates"]["alignment_shift"]["value"]) > 1.0
    assert abs(beside["estimates"]["alignment_shift"]["value"]) < 1.0
    assert main(["analyse", str(fast), "--reference", str(fast)]) == 2


FIVE = [  # K, J_l, speeds: natural frequencies 12, 18, 25, 40, 60 Hz; the stiffer, the faster one has to look
    (1630.0, 0.32, "60,40,25,15,9.6"),
    (3668.0, 0.32, "80,50,30,18,12"),
    (7160.0, 0.32, "100,70,45,28,15"),
    (18112.0, 0.32, "160,110,70,40,15"),
    (7160.0, 0.0516, "220,150,100,50,15"),
]


@pytest.mark.long
@pytest.mark.parametrize(("K", "J_l", "speeds"), FIVE)
def test_the_speed_that_is_slow_enough_is_that_of_linear_theory_on_five_gears(
    K: float, J_l: float, speeds: str
) -> None:
    rig = Rig((f"gear.K={K}", f"gear.J_l={J_l}"))
    result = analyse(rig.run(SpeedConvergence(speeds_rpm=speeds, amplitude_deg=1080.0, least=40.0)).run)
    found, predicted = figure(result, "speed_limit"), figure(result, "speed_limit_predicted")
    held, free = predicted.ci95
    assert found.value == pytest.approx(held, rel=0.15)
    assert found.value == pytest.approx(free, rel=0.15)
    assert found.ci95[0] <= free
    assert found.ci95[1] >= held
    grid = [float(word) for word in speeds.split(",")]
    best = figure(result, "chosen_speed").value
    assert min(abs(best / (0.993 * g) - 1.0) for g in grid) < 0.01, "one of the speeds run"


@pytest.mark.long
def test_a_full_turn_finds_what_was_planted_once_per_output_turn_and_on_the_flexspline() -> None:
    lines = "twin.effects.error_lines."
    rig = Rig((lines + "output_deg=0.002", lines + "flexspline_deg=0.0005"))
    result = analyse(rig.run(FullTurn(speed_rpm=19.7)).run)
    for name, true in (("line_0.02", 7.2), ("line_2.04", 1.8)):
        assert figure(result, name).ci95[0] <= true <= figure(result, name).ci95[1]
    assert figure(result, "line_0.04").value < 0.1
    maker, paper = figure(result, "transmission_accuracy"), figure(result, "kinematic_error_peak_to_peak")
    assert maker.value == pytest.approx(paper.value + 2 * 7.2 + 2 * 1.8, abs=2.0)


@pytest.mark.slow
def test_a_coast_down_gives_the_inertia_and_friction_of_the_plant() -> None:
    rig = Rig()
    result, gear = analyse(rig.run(CoastDown()).run), rig.bench.file.gear
    inertia = gear.J_m + gear.J_l / gear.N**2
    viscous = gear.B_m + gear.B_ml * (1 + 1 / gear.N) ** 2 + gear.B_l / gear.N**2
    coulomb = 0.30 + 1.0 / gear.N  # twin.tau_c, twin.F_cl
    for name, true in (("inertia_at_motor", inertia), ("viscous_friction", viscous), ("coulomb_torque", coulomb)):
        e = figure(result, name)
        assert e.ci95[0] <= true <= e.ci95[1], name
        assert e.value == pytest.approx(true, rel=0.04), name
    constant = figure(result, "time_constant")
    assert constant.value == pytest.approx(inertia / viscous, rel=0.015)
    assert constant.ci95[0] <= inertia / viscous <= constant.ci95[1]


@pytest.mark.slow
def test_coasts_of_each_way_begin_evenly_over_half_a_turn() -> None:
    columns = Rig().run(CoastDown(repeats=4)).run.columns
    speed, asked, theta = columns["omega_m"], columns["tau_ask"], columns["theta_m"]
    begin = np.flatnonzero((asked[1:] == 0.0) & (asked[:-1] != 0.0) & (np.abs(speed[1:]) > 40.0)) + 1
    assert begin.size == 8
    for way in (begin[::2], begin[1::2]):
        apart = np.sort(np.degrees(theta[way]) % 180.0)
        np.testing.assert_allclose(np.diff([*apart, apart[0] + 180.0]), 45.0, atol=8.0)


@pytest.mark.slow
def test_sentinels_of_an_unchanged_rig_agree_and_more_friction_shows_in_the_torque() -> None:
    rig = Rig()
    first, second = (analyse(rig.run(Sentinel()).run) for _ in range(2))
    torque = next(w for w in compare([first.estimates, second.estimates]) if w.name == "mean_motor_torque")
    assert abs(torque.change) <= 0.007, "two steps of the drive's torque"
    later = analyse(Rig(("twin.tau_c=0.35", "twin.tau_s=0.55")).run(Sentinel()).run)
    torque = next(w for w in compare([first.estimates, later.estimates]) if w.name == "mean_motor_torque")
    assert torque.changed
    assert torque.change == pytest.approx(0.05, abs=0.01)


@pytest.mark.slow
def test_a_standstill_without_torque_and_a_held_one_do_not_move_the_motor() -> None:
    for procedure in (Standstill(duration=4.0), HeldStandstill(duration=4.0)):
        taken = Rig().run(procedure)
        result = analyse(taken.run)
        assert next(c for c in result.checks if c.name == "still").passed
        assert figure(result, "noise_tau_l").value == pytest.approx(0.03, rel=0.1)
        assert figure(result, "zero_tau_m").value == pytest.approx(0.0, abs=0.002)
        asked = taken.run.columns["tau_ask"]
        assert math.isclose(float(np.max(np.abs(asked))), 0.0, abs_tol=0.02)
        assert np.ptp(taken.run.columns["theta_m"]) < TURN / 100
