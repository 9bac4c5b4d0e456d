"""A run at rest: the noise floor, after the run has settled, with what shakes."""

from __future__ import annotations

from typing import Any

import numpy as np

from rig.analysis import Result, analyse
from rig.analysis.sensors.standstill import settled_from
from tests.analysis.synthetic import ARCSEC, MadeRun, count


def at_rest(
    seed: int = 0, *, shake: float = 0.0, transient: float = 0.0, drift: float = 0.0, leant_on: float = 0.0
) -> Result:
    """Ten seconds: load angle with 0.8 arcsec of noise, torque with 0.05 N·m; a decaying transient [arcsec], a torque
    [N·m] that is gone after 3.8 s."""
    rng = np.random.default_rng(seed)
    t = np.arange(0, 10, 1e-3)
    load = rng.normal(0, 0.8, t.size) + shake * np.sin(2 * np.pi * 8.0 * t)
    load += transient * np.exp(-t / 0.1) * np.cos(30 * t) + drift * t / 60
    columns = {
        "t": t,
        "theta_m": np.zeros_like(t),
        "theta_l": count(load / ARCSEC, 900_000, 1e-7),
        "tau_l": 0.3 + rng.normal(0, 0.05, t.size) + leant_on * (t < 3.8),
    }
    return analyse(MadeRun(columns, {"procedure": "standstill", "gear": {"ratio": 50}}))


def figures(result: Result) -> dict[str, Any]:
    return {e.name: e for e in result.estimates}


def test_the_floor_is_noise_and_quantisation_together() -> None:
    found = figures(at_rest())
    expected = np.hypot(0.8, 1.44 / np.sqrt(12))
    assert abs(found["noise_theta_l"].value - expected) < 0.02
    low, high = found["noise_tau_l"].ci95
    assert low <= 0.05 <= high
    assert abs(found["zero_tau_l"].value - 0.3) < 0.003


def test_a_settling_transient_does_not_raise_the_floor() -> None:
    quiet, settling = figures(at_rest()), figures(at_rest(transient=120.0))
    assert abs(settling["noise_theta_l"].value - quiet["noise_theta_l"].value) < 0.03


def test_settling_ends_when_the_transient_has_gone_and_not_at_a_count_later_on() -> None:
    t = np.arange(0, 10, 1e-3)
    noise = np.random.default_rng(1).normal(0, 1, t.size)
    stepped = np.where((t > 3) & (t < 7), 1.0, 0.0)
    first = settled_from([noise + 200 * np.exp(-t / 0.1), stepped])
    assert 300 <= first <= 1500


def test_what_shakes_is_named_with_its_frequency() -> None:
    result = at_rest(shake=5.0)
    assert "8.00" in result.sentence
    line = result.tables["lines_at_rest"][0]
    assert line["channel"] == "theta_l"
    assert abs(float(line["frequency_hz"]) - 8.0) < 0.01
    assert abs(float(line["amplitude"]) - 5.0) < 0.1


def test_nothing_shakes_in_plain_noise() -> None:
    assert not any("shakes" in at_rest(seed).sentence for seed in range(8))


def test_drift_is_given_per_minute() -> None:
    low, high = figures(at_rest(drift=30.0))["drift_theta_l"].ci95
    assert low <= 30.0 <= high


def test_a_channel_that_never_left_one_count_has_noise_below_its_resolution() -> None:
    result = at_rest()
    assert figures(result)["noise_theta_m"].value == 0.0
    assert "one count" in figures(result)["noise_theta_m"].how
    assert any("Motor torque" in s for s in result.cannot)


def test_a_motor_that_moved_was_not_at_rest() -> None:
    t = np.arange(0, 10, 1e-3)
    result = analyse(MadeRun({"t": t, "theta_m": 0.05 * t}, {"procedure": "standstill", "gear": {"ratio": 50}}))
    assert not next(c for c in result.checks if c.name == "still").passed


def test_a_run_that_turns_is_no_standstill_whatever_its_manifest_says() -> None:
    """An import with the wrong procedure had a noise of a million arcsec, and no word against it."""
    t = np.arange(0, 10, 1e-3)
    result = analyse(MadeRun({"t": t, "theta_m": t}, {"procedure": "standstill", "gear": {"ratio": 50}}))
    assert result.verdict == "INCONCLUSIVE"
    said = "The samples are not what the manifest says: it says it is a standstill, and its motor goes 1.59 turns."
    assert said in result.sentence


def test_the_drift_of_an_angle_that_flips_by_single_counts_is_not_told_from_zero() -> None:
    count_arcsec = 1_296_000 / 65_536
    t = np.arange(0, 10, 1e-3)
    for flips in (t > 5, (t > 3) & (t < 3.2) | (t > 6)):
        theta = np.where(flips, count_arcsec, 0.0) / ARCSEC
        result = analyse(MadeRun({"t": t, "theta_m": theta}, {"procedure": "standstill", "gear": {"ratio": 50}}))
        low, high = figures(result)["drift_theta_m"].ci95
        assert low <= 0.0 <= high


def test_who_leans_on_the_rig_for_a_while_is_told_of_it() -> None:
    result = at_rest(leant_on=3.0)
    assert "The rig was not at rest for the first 3.8 s (shaft torque 3.3 → 0.3" in result.sentence
    assert abs(figures(result)["zero_tau_l"].value - 0.3) < 0.003
    assert not any("not at rest" in at_rest(seed, transient=120.0).sentence for seed in range(4))
