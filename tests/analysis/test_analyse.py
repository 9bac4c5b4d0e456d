"""Every run gets a Result: whatever is missing is said, nothing is raised, nothing is made up."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

from rig.analysis import Verdict, analyse
from rig.core.kinds import KINDS
from rig.core.units import TURN
from tests.analysis.synthetic import ARCSEC, PROFILE, MadeRun, count
from tests.some import some

PROCEDURES = tuple(KINDS)


def at_speed(rpm: float = 120.0, seconds: float = 10.0, **columns: Any) -> MadeRun:
    t = np.arange(0, seconds, 1e-3)
    theta_m = 3.0 + rpm / 60 * TURN * t
    theta_l = theta_m / 50 - PROFILE.value(theta_m)
    made = {"t": t, "theta_m": count(theta_m, 65_536), "theta_l": count(theta_l, 1_296_000)}
    about = {"procedure": "constant_torque", "gear": {"ratio": 50}, "conditions": {"speed_rpm": rpm}}
    return MadeRun({**made, **columns}, about)


@pytest.mark.slow
@pytest.mark.parametrize("rpm", [60.0, 120.0, -200.0, 400.0])
def test_a_run_at_speed_gives_speed_and_orders_and_does_not_call_it_the_pure_error(rpm: float) -> None:
    result = analyse(at_speed(rpm))
    found = {e.name: e for e in result.estimates}
    assert abs(found["mean_speed"].value - abs(rpm)) < 0.01
    assert abs(found["fourier_amplitude_2"].value - 39.6) < 0.1
    assert abs(found["kinematic_error_peak_to_peak"].value - PROFILE.peak_to_peak() * ARCSEC) < 0.3
    assert found["kinematic_error_peak_to_peak"].label.startswith("θ̃ at")
    assert any("pure part needs a slow run" in s for s in result.cannot)
    assert result.verdict is Verdict.MEASURED


@pytest.mark.slow
@pytest.mark.parametrize("procedure", some(PROCEDURES, 5))
def test_any_columns_may_be_missing_in_any_procedure(procedure: str) -> None:
    whole = at_speed(seconds=4.0, tau_l=np.zeros(4000), tau_m=np.zeros(4000), theta_ref=np.zeros(4000))
    for size in range(len(whole.columns) + 1):
        for names in itertools.combinations(whole.columns, size):
            run = MadeRun({n: whole.columns[n] for n in names}, {"procedure": procedure, "gear": {"ratio": 50}})
            result = analyse(run)
            assert result.sentence
            assert all(np.isfinite(e.value) for e in result.estimates if not e.name.startswith("drift"))


@pytest.mark.parametrize("procedure", PROCEDURES)
@pytest.mark.parametrize("rows", [0, 1, 5, 40, 700])
def test_a_run_cut_short_is_no_error(procedure: str, rows: int) -> None:
    whole = at_speed()
    columns = {n: c[:rows] for n, c in whole.columns.items()}
    assert analyse(MadeRun(columns, {"procedure": procedure, "status": "interrupted"})).sentence


@pytest.mark.slow
def test_counts_alone_are_enough_when_the_encoders_are_declared() -> None:
    whole = at_speed()
    counts = {
        "t": whole.columns["t"],
        "counts_m": np.round(whole.columns["theta_m"] / TURN * 65_536),
        "counts_l": np.round(whole.columns["theta_l"] / TURN * 1_296_000),
    }
    about = {**whole.manifest, "encoders": {"motor_counts_per_rev": 65_536, "load_counts_per_rev": 1_296_000}}
    amplitude = next(e for e in analyse(MadeRun(counts, about)).estimates if e.name == "fourier_amplitude_2")
    assert abs(amplitude.value - 39.6) < 0.1


@pytest.mark.slow
def test_a_wrapped_angle_is_unwrapped_and_said() -> None:
    whole = at_speed()
    wrapped = {**whole.columns, "theta_m": np.mod(whole.columns["theta_m"], TURN)}
    result = analyse(MadeRun(wrapped, whole.manifest))
    assert any("unwrapped" in s for s in result.cannot)
    assert abs(next(e for e in result.estimates if e.name == "fourier_amplitude_2").value - 39.6) < 0.1


@pytest.mark.slow
def test_a_procedure_without_an_analysis_of_its_own_says_so() -> None:
    whole = at_speed()
    result = analyse(MadeRun(whole.columns, {**whole.manifest, "procedure": "wobble"}))
    assert any("no analysis for wobble" in s for s in result.cannot)
    assert "fourier_amplitude_2" in {e.name for e in result.estimates}


def test_angles_taken_for_each_other_in_a_short_run_are_told_so() -> None:
    columns = at_speed(rpm=20.0, seconds=30.0).columns
    swapped = {**columns, "theta_m": columns["theta_l"], "theta_l": columns["theta_m"]}
    result = analyse(MadeRun(swapped, {"procedure": "other", "gear": {"ratio": 50}}))
    assert result.sentence.startswith("The motor moved 72.")
    assert "less than a turn: θ_m and θ_l seem to be taken for each other" in result.sentence


def test_too_few_rows_a_turn_is_said_and_not_fitted() -> None:
    t = np.arange(0, 10, 0.1)
    run = MadeRun({"t": t, "theta_m": 40.0 * t, "theta_l": 0.8 * t}, {"procedure": "constant_torque"})
    result = analyse(run)
    assert any("too few" in s for s in result.cannot)
    assert "coefficients" not in result.tables


def test_a_check_is_told_by_what_it_found_and_not_called_inconclusive_for_its_short_way() -> None:
    run = at_speed(rpm=15.0, seconds=4.0)
    there_and_back = {name: np.concatenate([x, x[::-1]]) for name, x in run.columns.items() if name != "t"}
    t = np.arange(2 * run.columns["t"].size) * 1e-3
    about = {"procedure": "other", "label": "sign-and-scale", "gear": {"ratio": 50}}
    result = analyse(MadeRun({"t": t, **there_and_back}, about | {"finding": "ratio 50.003 (declared 50)"}))
    assert (result.verdict, result.sentence) == (Verdict.MEASURED, "ratio 50.003 (declared 50)")
    assert analyse(MadeRun({"t": t, **there_and_back}, about)).verdict is Verdict.INCONCLUSIVE
