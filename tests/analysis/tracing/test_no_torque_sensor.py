"""Where no torque is measured, what stands in for it has its sensor's noise, and lacks what the bearings take."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.floor.held_out import left_unseen, unseen
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.runs.record import record
from rig.analysis.tracing.runs.stand_ins import in_stand_ins, reloaded
from rig.analysis.tracing.trace import trace
from rig.runfile.run import Run
from tests.analysis.tracing.test_few_channels import reduced
from tests.contract.test_effects import motion

RUNS = ("slow_ke_1", "slow_ke_2", *(f"speed_{s}rpm_{i}" for s in ("60", "200", "400", "minus400") for i in (1, 2)))


def test_the_noise_of_the_load_angle_is_in_the_torque_of_the_inertia_twice_differentiated() -> None:
    s = motion()
    t = s.dt * np.arange(s.t.size)
    wave = 1e-6 * np.sin(2 * np.pi * 10.0 * t)
    torque = in_stand_ins({"theta_m": wave, "theta_l": wave, "tau_m": wave}, s, s.dt, locked=False, timed=True)["tau_l"]
    middle = slice(500, -500)
    assert torque[middle] == pytest.approx(-s.gear.J_l * (2 * np.pi * 10.0) ** 2 * wave[middle], abs=1e-6)


def test_what_is_measured_has_its_own_noise_alone(rng: np.random.Generator) -> None:
    noise = rng.standard_normal(motion().t.size)
    read = dict.fromkeys(("theta_m", "theta_l", "tau_m", "tau_l"), noise)
    assert in_stand_ins(read, motion(), motion().dt, locked=False, timed=True) == {}


@pytest.mark.slow
def test_stiffness_and_inertia_are_right_and_the_fast_runs_at_the_floor(tmp_path: Path, shared: Path) -> None:
    truth = json.loads((shared / "cases" / "TRUTH.json").read_text())["open-1"]["baseline"]
    p = prepare(read_campaign(reduced(tmp_path, shared / "cases" / "open-1", RUNS, ("tau_l",))), ())
    assert 1 / p.baseline.value("compliance") == pytest.approx(truth["K"], rel=6e-3)
    assert p.baseline.value("J_m") == pytest.approx(truth["Jm"], rel=5e-3)
    left = p.held_out.residuals(p.baseline, unseen(p.baseline, p.held_out))
    fast = {key: p.held_out.ratio(left, [key]) for key in left if "400" in p.eq.runs[key[0]].name}
    assert fast
    assert max(fast.values()) < 1.1, fast
    run_by_run = left_unseen(p.baseline, p.held_out)
    assert list(run_by_run) == list(left)
    assert all(np.array_equal(run_by_run[key], left[key]) for key in left)


@pytest.mark.slow
def test_in_lock_tests_the_motor_holds_what_the_wind_up_says(tmp_path: Path, shared: Path) -> None:
    truth = json.loads((shared / "cases" / "TRUTH.json").read_text())["open-1"]["baseline"]
    p = prepare(
        read_campaign(reduced(tmp_path, shared / "cases" / "open-1", (*RUNS, "lock_60_1", "lock_60_2"), ("tau_l",))), ()
    )
    assert p.baseline.value("tau_c") == pytest.approx(truth["Tc"], rel=5e-3)
    left = p.held_out.residuals(p.baseline, unseen(p.baseline, p.held_out)) | {
        key: p.baseline.residual(key) for key in p.baseline.keys
    }
    locked = {key: float(np.std(e)) for key, e in left.items() if p.eq.runs[key[0]].locked}
    assert [channel for _, channel in locked] == ["M", "M"]
    assert max(locked.values()) < 1.5 * p.measured.noise.sigma["M"], locked


RUBS = {"tau_cl": 0.5, "B_l": 2.0}


def test_effects_go_by_what_the_bearings_take_and_the_equations_by_the_inertia_alone() -> None:
    s = motion()
    plain, rubbing = (reloaded(s, known, None, timed=True) for known in (s.gear, replace(s.gear, **RUBS)))
    np.testing.assert_array_equal(rubbing.tau_l, plain.tau_l)
    np.testing.assert_allclose(rubbing.torque - plain.torque, 0.5 * s.way + 2.0 * s.omega_l, atol=1e-12)


@pytest.mark.parametrize(("drop", "goes_by"), [(("tau_l",), True), ((), False), (("tau_l", "tau_m"), False)])
def test_a_run_goes_by_it_where_nobody_read_the_torque_and_its_noise_has_none_of_it(
    tmp_path: Path, shared: Path, drop: tuple[str, ...], goes_by: bool
) -> None:
    name = "speed_200rpm_1"
    run = record(Run.open(reduced(tmp_path, shared / "cases" / "open-1", (name,), drop) / name), 0.0)
    (bare,) = run.pieces
    (knows,) = run.knowing(replace(bare.gear, **RUBS)).pieces
    more = 0.5 * bare.way + 2.0 * bare.omega_l
    np.testing.assert_allclose(knows.torque - bare.torque, more if goes_by else 0.0 * more, atol=1e-12)
    (noisy,) = run.knowing(knows.gear).noisier(1).pieces
    (noise,) = run.noisier(1).pieces
    np.testing.assert_allclose(noisy.torque - knows.torque, noise.torque - bare.torque, atol=1e-12)


@pytest.mark.slow
@pytest.mark.long
def test_a_kinematic_error_that_shrinks_is_as_large_as_by_a_torque_sensor(tmp_path: Path, shared: Path) -> None:
    truth = json.loads((shared / "cases" / "TRUTH.json").read_text())["open-2"]["parameters"]
    loaded = [f"load_{load}nm_{i}" for load in ("2.5", "5", "20") for i in (1, 2)]
    found = trace(reduced(tmp_path, shared / "cases" / "open-2", (*RUNS, *loaded), ("tau_l",)))
    assert found.verdict.effects == ("load_dependent_kinematic_error",)
    told = {p.name: p.value for p in found.effects[0].parameters}
    assert told["A_inf"] == pytest.approx(truth["lke_inf"], abs=0.015), "without friction in T it is 0.04 too high"
    assert told["T_c"] == pytest.approx(truth["lke_tau"], rel=0.1)
