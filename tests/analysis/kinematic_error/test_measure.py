"""A slow run to its kinematic error: what is found is what was put in, and what was not run is said."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from rig.analysis import Result, Verdict, analyse
from tests.analysis.synthetic import ARCSEC, PROFILE, TURN, MadeRun, slow_run

PEAK_TO_PEAK = PROFILE.peak_to_peak() * ARCSEC


def figures(result: Result) -> dict[str, Any]:
    return {e.name: e for e in result.estimates}


def only(run: MadeRun, *names: str) -> MadeRun:
    return replace(run, columns={n: run.columns[n] for n in names})


@pytest.fixture(scope="module")
def made() -> MadeRun:
    return slow_run(5)


@pytest.fixture(scope="module")
def result(made: MadeRun) -> Result:
    return analyse(made)


def test_the_coefficients_are_those_that_were_put_in(result: Result) -> None:
    rows = result.tables["coefficients"]
    a = np.array([r["a_arcsec"] for r in rows], float)
    b = np.array([r["b_arcsec"] for r in rows], float)
    assert np.allclose(a, np.array(PROFILE.a) * ARCSEC, atol=0.12)
    assert np.allclose(b, np.array(PROFILE.b) * ARCSEC, atol=0.12)


def test_amplitude_and_phase_are_those_of_the_model(result: Result) -> None:
    row = result.tables["coefficients"][1]
    assert row["C_lo"] <= PROFILE.amplitude[1] * ARCSEC <= row["C_hi"]
    assert abs(float(row["phase_deg"]) - np.rad2deg(PROFILE.phase[1])) < 0.3


def test_the_peak_to_peak_is_a_figure_with_an_interval_that_holds_the_truth(result: Result) -> None:
    figure = figures(result)["kinematic_error_peak_to_peak"]
    low, high = figure.ci95
    assert low <= PEAK_TO_PEAK <= high
    assert high - low < 1.0, "half an arcsec either way, of 94"
    assert figure.unit == "arcsec"
    assert result.verdict is Verdict.MEASURED


def test_an_order_of_a_fifth_of_an_arcsec_is_resolved_and_one_of_nothing_is_not() -> None:
    still = replace(PROFILE, a=(*PROFILE.a[:13], 0.0, 0.0), b=(*PROFILE.b[:13], 0.0, 0.0))
    rows = analyse(slow_run(2, profile=still)).tables["coefficients"]
    assert rows[13]["C_lo"] == 0.0
    assert np.isnan(float(rows[13]["phase_deg"]))
    assert float(rows[12]["C_lo"]) > 0.0


def test_the_offset_between_directions_is_half_the_gap_and_its_sign_is_that_of_friction(result: Result) -> None:
    """Friction on the load makes it lag both ways: θ̃ is higher forward, by F_cl/K to either side of the middle."""
    figure = figures(result)["direction_offset"]
    assert abs(figure.value - 28.8) < 0.15
    reverse = figures(analyse(slow_run(5, offset=-28.8)))["direction_offset"]
    assert abs(reverse.value + 28.8) < 0.15


def test_whole_revolutions_are_counted_in_both_directions(result: Result) -> None:
    assert figures(result)["revolutions_forward"].value == 13
    assert figures(result)["revolutions_reverse"].value == 14


def test_eccentricity_of_the_output_is_reported_as_trend_and_leaves_the_coefficients_alone() -> None:
    result = analyse(slow_run(3, trend_arcsec=60.0))
    found = figures(result)
    a2 = np.hypot(PROFILE.a[1], PROFILE.b[1]) * ARCSEC
    assert abs(found["fourier_amplitude_2"].value - a2) < 0.15
    stroke = np.deg2rad(28.8) * np.array([-7 / 8, 7 / 8])
    angles = np.linspace(*stroke, 100)
    truth = np.ptp(60.0 * np.sin(angles + 0.7))
    assert abs(found["trend_peak_to_peak"].value - truth) < 1.0
    assert found["trend_slope"].value > 0.5


def test_drift_with_time_is_told_from_the_output_angle_by_going_back() -> None:
    run = slow_run(4)
    drift = 3.0 / ARCSEC * run.columns["t"] / 60.0
    result = analyse(replace(run, columns={**run.columns, "theta_l": run.columns["theta_l"] - drift}))
    found = figures(result)
    assert abs(found["drift"].value - 3.0) < 0.2
    assert abs(found["trend_slope"].value) < 0.02


def test_curves_have_the_names_and_shapes_that_the_report_draws(result: Result) -> None:
    c = result.curves
    assert c["ke.theta_deg"].size >= 512
    for name in ("ke.mean_forward", "ke.mean_reverse", "ke.pure", "ke.direction", "ke.fit"):
        assert c[name].shape == c["ke.theta_deg"].shape
        assert abs(c[name].mean()) < 0.2
    assert c["ke.revolutions_forward"].shape == (13, c["ke.theta_deg"].size)
    assert c["ke.revolutions_reverse"].shape == (14, c["ke.theta_deg"].size)
    assert np.allclose(c["ke.pure"], c["ke.fit"], atol=1.0)
    truth = PROFILE.value(np.deg2rad(c["ke.theta_deg"])) * ARCSEC
    assert np.allclose(c["ke.fit"], truth, atol=0.4)
    assert c["orders.order"].tolist() == list(range(1, 16))
    assert c["spectrum.order"].max() <= 40.0
    assert c["time.t"].size <= 2000
    assert c["time.speed_min"].size == c["time.t"].size
    assert all(array.dtype == np.float64 for array in c.values())


def test_the_series_is_as_long_as_the_error_needs(result: Result) -> None:
    mse = result.curves["mse.value"]
    assert np.all(np.diff(mse) <= 0)
    assert np.isclose(mse[0], np.mean(result.curves["ke.pure"] ** 2))
    short = replace(PROFILE, a=PROFILE.a[:4], b=PROFILE.b[:4])
    assert figures(analyse(slow_run(1, profile=short)))["fourier_terms"].value == 4


def test_one_direction_says_what_it_cannot_tell_and_does_the_rest(made: MadeRun) -> None:
    rows = slice(76_000, 124_000)  # the second forward stroke
    result = analyse(replace(made, columns={n: c[rows] for n, c in made.columns.items()}))
    found = figures(result)
    assert any("one direction" in s for s in result.cannot)
    assert "direction_offset" not in found
    assert "ke.direction" not in result.curves
    assert abs(found["fourier_amplitude_2"].value - 39.6) < 0.3


def test_without_time_the_orders_are_the_same_and_smoothness_is_unknown(made: MadeRun, result: Result) -> None:
    timeless = analyse(only(made, "theta_m", "theta_l"))
    assert any("time" in s for s in timeless.cannot)
    assert "mean_speed" not in figures(timeless)
    for mine, theirs in zip(timeless.tables["coefficients"], result.tables["coefficients"], strict=True):
        assert abs(float(mine["a_arcsec"]) - float(theirs["a_arcsec"])) < 1e-6


def test_a_flipped_encoder_is_named_and_no_error_is_shown(made: MadeRun) -> None:
    result = analyse(replace(made, columns={**made.columns, "theta_l": -made.columns["theta_l"]}))
    assert result.verdict is Verdict.INCONCLUSIVE
    assert "flip the sign" in result.sentence
    assert "kinematic_error_peak_to_peak" not in figures(result)


def test_a_wrong_ratio_is_named(made: MadeRun) -> None:
    result = analyse(replace(made, manifest={**made.manifest, "gear": {"ratio": 51}}))
    assert result.verdict is Verdict.INCONCLUSIVE
    assert "50" in result.sentence


def test_a_ratio_off_by_half_a_per_cent_is_doubted(made: MadeRun) -> None:
    result = analyse(replace(made, manifest={**made.manifest, "gear": {"ratio": 50.25}}))
    assert result.verdict is Verdict.INCONCLUSIVE
    assert "50.0" in result.sentence
    assert "declared 50.25" in result.sentence


@pytest.mark.slow
def test_a_gear_wound_up_along_the_angle_is_no_other_ratio(made: MadeRun) -> None:
    """A weight on an arm: θ_l follows τ_l/K, and without that torque it would look like another ratio."""
    K = 7160.0
    tau_l = 40.0 * made.columns["theta_l"]
    bent = {**made.columns, "theta_l": made.columns["theta_l"] - tau_l / K}
    manifest = {**made.manifest, "declared": {"K": K}}
    assert analyse(MadeRun(bent, manifest)).verdict is Verdict.INCONCLUSIVE
    assert analyse(MadeRun({**bent, "tau_l": tau_l}, manifest)).verdict is not Verdict.INCONCLUSIVE


@pytest.mark.slow
def test_what_inertia_adds_is_taken_off_when_it_is_declared() -> None:
    """At J_l/K a hundred times the twin's, order 2 is seen 2 % too large: (1 − r²)·seen must give the truth back."""
    K, J_l = 7160.0, 32.0
    omega = 4 * 4.0 * 0.01 * TURN
    r2 = (PROFILE.orders * omega) ** 2 * J_l / K
    grown = replace(PROFILE, a=tuple(PROFILE.a / (1 - r2)), b=tuple(PROFILE.b / (1 - r2)))
    cut = replace(grown, a=grown.a[:4], b=grown.b[:4])
    result = analyse(slow_run(6, profile=cut, manifest={"declared": {"K": K, "J_l": J_l}}))
    row = result.tables["coefficients"][1]
    assert abs(float(row["C_arcsec"]) - 39.6) < 0.15
    assert row["C_lo"] <= 39.6 <= row["C_hi"]
    plain = analyse(slow_run(6, profile=cut))
    assert abs(float(plain.tables["coefficients"][1]["C_arcsec"]) - 39.6 / (1 - r2[1])) < 0.15
    assert any("not declared" in s for s in plain.cannot)


@pytest.mark.parametrize(
    ("limit", "verdict"), [(120.0, Verdict.PASS), (60.0, Verdict.FAIL), (PEAK_TO_PEAK, Verdict.INCONCLUSIVE)]
)
def test_a_limit_in_the_manifest_makes_a_verdict(made: MadeRun, limit: float, verdict: Verdict) -> None:
    manifest = {**made.manifest, "limits": {"kinematic_error_peak_to_peak": {"upper": limit}}}
    assert analyse(replace(made, manifest=manifest)).verdict is verdict


def test_a_tripped_run_is_analysed_as_far_as_it_went_and_cannot_pass(made: MadeRun) -> None:
    about = {
        "status": "tripped",
        "exit_reason": "shaft torque 46.0 N·m",
        "limits": {"kinematic_error_peak_to_peak": 120},
    }
    half = {n: c[:110_000] for n, c in made.columns.items()}
    result = analyse(replace(made, columns=half, manifest={**made.manifest, **about}))
    assert result.verdict is Verdict.INCONCLUSIVE
    assert "tripped" in result.sentence
    assert "46.0" in result.sentence
    assert "kinematic_error_peak_to_peak" in figures(result)


def test_stale_rows_and_missing_angles_are_left_out(made: MadeRun, result: Result) -> None:
    rng = np.random.default_rng(0)
    columns = {n: c.copy() for n, c in made.columns.items()}
    columns["flags"] = np.zeros_like(columns["t"])
    bad = rng.choice(columns["t"].size, 4000, replace=False)
    columns["flags"][bad[:2000]] = 4.0  # STALE_L
    columns["theta_l"][bad[:2000]] += 1.0
    columns["theta_l"][bad[2000:]] = np.nan
    again = analyse(replace(made, columns=columns))
    assert any("4000 of 200000 rows" in s for s in again.cannot)
    assert abs(figures(again)["fourier_amplitude_2"].value - figures(result)["fourier_amplitude_2"].value) < 0.02


def test_two_speeds_are_not_mixed_and_the_slower_one_is_the_kinematic_error() -> None:
    slow, fast = slow_run(1, cycles=1), slow_run(2, cycles=1, frequency=0.03)
    columns = {n: np.concatenate((slow.columns[n], fast.columns[n])) for n in slow.columns}
    columns["t"] = np.arange(columns["t"].size) * 1e-3
    result = analyse(replace(slow, columns=columns, manifest={**slow.manifest, "procedure": "kinematic_error"}))
    assert abs(figures(result)["mean_speed"].value - 9.6) < 0.05
    assert [round(float(r["speed_rpm"]), 1) for r in result.tables["speeds"]] == [9.6, 28.8]


@pytest.mark.parametrize(("every", "verdict"), [(100, Verdict.PASS), (200, Verdict.INCONCLUSIVE)])
def test_a_series_that_is_cut_short_by_the_row_rate_meets_no_limit(made: MadeRun, every: int, verdict: Verdict) -> None:
    """At 10 Hz and 9.6 rpm all orders are in the series; at 5 Hz it ends at order 7, the peak to peak too small."""
    columns = {name: column[::every] for name, column in made.columns.items()}
    limits = {"kinematic_error_peak_to_peak": 1000.0}
    few = analyse(replace(made, columns=columns, manifest={**made.manifest, "limits": limits}))
    assert few.verdict is verdict
    told = [check.sentence for check in few.checks if check.name == "orders"]
    assert [s.startswith("The rows are too few per turn for 15 orders: the series ends at order 7.") for s in told] == [
        True
    ] * (verdict is Verdict.INCONCLUSIVE)
    assert all(s in few.sentence for s in told)
