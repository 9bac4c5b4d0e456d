"""Identification on noiseless runs of the simulator, and on campaigns of an independent plant with known truth."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from rig.analysis.identify.fit import fit
from rig.analysis.identify.gram import Rows, known, solve
from rig.analysis.identify.identified import Identified, identified, order_amplitudes
from rig.analysis.identify.locked import locked_rows
from rig.analysis.identify.recording import Recording, plateaus, recording
from rig.analysis.identify.solve import random_effects
from rig.analysis.identify.windows import overlap_inflation
from rig.bench import read, twin_parameters
from rig.core.errors import DataError
from rig.model.gear import Gear
from rig.model.simulate import Start, at_speed, under_torque
from rig.runfile.run import Run

pytestmark = pytest.mark.xdist_group("identify")  # what the module makes is made once, not for every worker

Array = npt.NDArray[np.float64]
RPM = np.pi / 30
ARCSEC = 180 / np.pi * 3600
LATE = 0.4e-3  # s, of the load encoder in the test that looks for it


class Made:
    """A run in memory."""

    def __init__(self, name: str, columns: dict[str, Array], **conditions: Any) -> None:
        self.name, self.columns = name, columns
        self.manifest: Mapping[str, Any] = {
            "gear": {"ratio": 50.0, "output": "flexspline"}, "declared": {"B_ml": 2.5e-3},
            "conditions": conditions, "encoders": {}, "procedure": "constant_torque",
        }  # fmt: skip
        self.ratio, self.procedure, self.conditions = 50.0, "constant_torque", conditions
        self.declared = self.manifest["declared"]

    def column(self, name: str) -> Array | None:
        return self.columns.get(name)

    def has(self, name: str) -> bool:
        return name in self.columns


@pytest.fixture(scope="module")
def gear() -> Gear:
    found: Gear = twin_parameters(read("twin").file).gear
    return replace(found, tau_s=found.tau_c)


def turning(gear: Gear, rpm: float, seconds: float) -> Made:
    """A noiseless run at constant torque from the simulator (another method than the fit's)."""
    wave, t = at_speed(gear, rpm * RPM), np.arange(0.0, seconds, 1e-3)
    begin = Start(0.0, float(wave.omega_m[0]), -float(wave.kinematic_error[0]), float(wave.omega_l[0]))
    x = under_torque(gear, t, np.full(t.size, wave.tau), start=begin, step=1e-4)
    noise = np.random.default_rng(abs(int(rpm))).standard_normal(t.size)
    torque = x.shaft_torque + 1e-4 * noise  # a little, or χ² would be that of rounding
    columns = {"t": t, "theta_m": x.theta_m, "theta_l": x.theta_l, "tau_l": torque, "tau_m": wave.tau + 1e-6 * noise}
    return Made(f"speed_{rpm:g}", columns)


@pytest.fixture(scope="module")
def campaign(gear: Gear) -> list[Recording]:
    runs = [turning(gear, rpm, 6.0) for rpm in (150, 300, 450, -150, -300, -450)]
    return [r for run in runs if (r := recording(run)) is not None]


@pytest.mark.slow
def test_without_noise_every_parameter_is_that_of_the_simulator(gear: Gear, campaign: list[Recording]) -> None:
    found = identified(fit(campaign, 15), {"declared": {"B_ml": 2.5e-3}}).parameters
    for name in ("J_m", "J_l", "K", "B_sp"):
        assert found[name].value == pytest.approx(getattr(gear, name), rel=2e-3), name
    assert found["B_sum"].value == pytest.approx(gear.B_m + gear.B_ml * 1.02**2, rel=2e-3)
    assert found["tau_c"].value == pytest.approx(gear.tau_c, rel=1e-3)
    assert found["F_cl"].value == pytest.approx(gear.F_cl, rel=2e-3)
    assert found["B_l"].value == pytest.approx(gear.B_l, rel=5e-3)


@pytest.mark.slow
def test_without_a_slow_run_the_pure_error_still_comes_out_of_the_runs_at_speed(
    gear: Gear, campaign: list[Recording]
) -> None:
    found = identified(fit(campaign, 15), {})
    for n, size, _ in order_amplitudes(found.series):
        assert size * ARCSEC == pytest.approx(float(gear.kinematic_error.amplitude[n - 1]) * ARCSEC, abs=0.05)


@pytest.mark.slow
def test_an_encoder_that_reads_late_is_found_and_does_not_pass_for_damping(
    gear: Gear, campaign: list[Recording]
) -> None:
    late = [r.with_load_late_by(-LATE) for r in campaign]
    found = identified(fit(late, 15), {}).parameters
    assert found["skew"].value == pytest.approx(LATE, rel=0.03)
    in_step = identified(fit(campaign, 15), {}).parameters["lag"].value
    assert found["lag"].value == pytest.approx(in_step - LATE, abs=found["lag"].half), "behind load angles as recorded"
    assert found["B_sp"].value == pytest.approx(gear.B_sp, rel=0.02)
    assert found["K"].value == pytest.approx(gear.K, rel=0.005)


@pytest.mark.slow
def test_what_no_run_shows_is_declared_or_assumed_and_said(campaign: list[Recording]) -> None:
    bare = [replace(r, tau_l=None) for r in campaign]
    found = identified(fit(bare, 15), {"declared": {"K": 7160.0, "J_l": 0.3, "J_m": 1e-3}})
    assert found.parameters["K"].origin == "declared"
    assert any(s.startswith("Stiffness K: nothing here shows it") for s in found.cannot)
    with pytest.raises(DataError, match=r"neither measured here nor declared.*; no run here has tau_l$"):
        identified(fit(bare, 15), {}).gear_file("", True, "", ["tau_l"])


@pytest.mark.slow
def test_pairs_that_cannot_be_told_apart_are_named(campaign: list[Recording]) -> None:
    said = " ".join(identified(fit(campaign, 15), {}).cannot)
    for pair in ("B_m and B_ml", "K of the gear and of what lies in series", "B_sp and B_ml", "tau_s and omega_s"):
        assert pair in said


def test_plateaus_of_a_staircase_are_found_with_whole_turns() -> None:
    t = np.arange(0.0, 30.0, 1e-3)
    omega = np.where(t < 10, 5.0, np.where(t < 20, 10.0, -10.0))
    theta = np.concatenate(([0.0], np.cumsum(omega[:-1]) * 1e-3))
    run = recording(Made("stairs", {"t": t, "theta_m": theta, "theta_l": theta / 50}))
    assert run is not None
    found = plateaus(run)
    assert [round(p.omega, 2) for p in found] == [5.0, 10.0, -10.0]
    for p in found:
        turns = (theta[p.hi] - theta[p.lo]) / (2 * np.pi)
        assert turns == pytest.approx(round(turns), abs=0.01)


def test_a_torque_that_follows_a_reference_and_one_that_does_not_are_two_plateaus() -> None:
    t = np.arange(0.0, 20.0, 1e-3)
    reference = np.where(t < 10, 10.0 * t, np.nan)
    run = recording(Made("both", {"t": t, "theta_m": 10.0 * t, "theta_l": 0.2 * t, "theta_ref": reference}))
    assert run is not None
    assert [p.followed for p in plateaus(run)] == [True, False]


def test_a_motor_that_sticks_on_its_counts_widens_the_stiffness_of_a_lock_run() -> None:
    """Steps of one count, each held for a second: 40 independent errors, not 4000."""
    generator, errors, halves = np.random.default_rng(5), [], []
    K, count = 7000.0, 2 * np.pi / 10000
    for _ in range(60):
        t = np.arange(0.0, 40.0, 0.01)
        true = 0.1 * np.sin(2 * np.pi * (np.floor(t) + generator.uniform()) / 40.0) + generator.uniform()
        seen = np.floor(true / count) * count
        torque = K * (true - true.mean()) / 50 + 0.01 * generator.standard_normal(t.size)
        made = Made("lock", {"t": t, "theta_m": seen, "theta_l": 0 * t, "tau_l": torque}, output_locked=True)
        made.manifest = {**made.manifest, "encoders": {"motor_counts_per_rev": 10000}}
        run = recording(made)
        assert run is not None
        part = locked_rows(run, 1, 5, 2, np.zeros(5), 1)
        assert part is not None
        errors.append(part.g[2] / part.H[2, 2] * K - 1.0)
        halves.append(1.96 * K / np.sqrt(part.H[2, 2]))
    assert 0.85 <= np.mean(np.abs(errors) < halves) <= 1.0
    assert np.mean(halves) < 4.0 * 1.96 * np.std(errors)


@pytest.mark.slow
def test_phasor_rows_give_intervals_that_cover() -> None:
    generator, hits = np.random.default_rng(3), 0
    for _ in range(200):
        X = np.tile(generator.standard_normal((1, 10, 2)) + 1j * generator.standard_normal((1, 10, 2)), (8, 1, 1))
        noise = generator.standard_normal((8, 10)) + 1j * generator.standard_normal((8, 10))
        found = solve([Rows("a", X, X @ np.array([2.0, -1.0]) + 0.3 * noise, 1.0)], [], 2)
        assert found is not None
        hits += abs(found.coefficients[0] - 2.0) < found.half(0)
    assert 180 <= hits <= 198  # 95 % of 200, within three standard errors


def test_runs_that_disagree_widen_the_interval() -> None:
    ones = np.ones((1, 1))
    agree = solve([], [known(str(i), ones, np.array([1.0]), 1e-4) for i in range(6)], 1)
    apart = solve([], [known(str(i), ones, np.array([float(i)]), 1e-4) for i in range(6)], 1)
    assert agree is not None
    assert apart is not None
    assert agree.u(0) == pytest.approx(0.01 / np.sqrt(6))
    assert apart.u(0) == pytest.approx(np.std(np.arange(6.0), ddof=1) / np.sqrt(6), rel=0.05)


@pytest.mark.slow
def test_scatter_between_runs_is_found_beside_their_own() -> None:
    generator, found = np.random.default_rng(1), []
    for _ in range(100):
        X = np.column_stack((np.ones(20), np.arange(20.0)))
        y = X @ np.array([1.0, 0.5]) + 0.3 * generator.standard_normal(20) + 0.1 * generator.standard_normal(20)
        found.append(random_effects(X, y, np.full(20, 0.01)).between)
    assert np.mean(found) == pytest.approx(0.3, rel=0.1)


def test_overlapping_windows_count_for_less_than_their_number() -> None:
    w = np.sin(np.pi * (np.arange(300) + 0.5) / 300) ** 4
    noise = np.random.default_rng(2).standard_normal((4000, 700))
    means = np.mean([noise[:, a : a + 300] @ w for a in (0, 100, 200, 300, 400)], axis=0)
    assert np.var(means) / (np.sum(w**2) / 5) == pytest.approx(overlap_inflation(5), rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("case", ["open-1", *(pytest.param(c, marks=pytest.mark.long) for c in ("open-5", "open-6"))])
def test_a_campaign_of_an_independent_plant_gives_its_true_parameters(shared: Path, case: str) -> None:
    true = json.loads((shared / "cases" / "TRUTH.json").read_text())[case]
    b, found = true["baseline"], of_case(shared / "cases" / case)
    p = found.parameters
    for name, value, within in (
        ("K", b["K"], 3e-4), ("J_l", b["Jl"], 2e-3), ("J_m", b["Jm"], 2e-3), ("B_sp", b["Bsp"], 0.02),
        ("tau_c", b["Tc"], 3e-3), ("F_cl", b["Tl"], 0.015),
    ):  # fmt: skip
        assert p[name].value == pytest.approx(value, rel=within), name
        assert abs(p[name].value - value) < 2.0 * p[name].half, name
    C2 = float(np.hypot(true["kinematic_error_a_rad"][2], true["kinematic_error_b_rad"][2]))
    assert order_amplitudes(found.series)[1][1] * ARCSEC == pytest.approx(C2 * ARCSEC, abs=0.05)


@pytest.mark.slow
@pytest.mark.long
def test_an_encoder_late_by_a_millisecond_spoils_nothing(shared: Path) -> None:
    true = json.loads((shared / "cases" / "TRUTH.json").read_text())["open-4"]
    p = of_case(shared / "cases" / "open-4").parameters
    assert p["skew"].value == pytest.approx(true["parameters"]["skew"], rel=0.02)
    assert p["K"].value == pytest.approx(true["baseline"]["K"], rel=1e-3)
    assert p["B_sp"].value == pytest.approx(true["baseline"]["Bsp"], rel=0.03)


@pytest.mark.slow
def test_a_hysteretic_gear_has_two_stiffnesses_and_both_are_told(shared: Path) -> None:
    found = of_case(shared / "cases" / "open-3")
    low, high = found.parameters["K"].interval
    assert low < 7100 < 7500 < high
    assert any("contradict" in s or "standard errors apart" in s for s in found.cannot)


def of_case(folder: Path) -> Identified:
    runs = [Run.open(p) for p in sorted(folder.iterdir()) if p.is_dir()]
    return identified(fit([r for run in runs if (r := recording(run)) is not None], 15), runs[0].manifest)
