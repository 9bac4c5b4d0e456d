"""Where no torque is measured, what stands in for it has its sensor's noise, and lacks what the bearings take."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.runs.stand_ins import in_stand_ins
from rig.analysis.tracing.selection.held_out import unseen
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
