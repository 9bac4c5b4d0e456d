"""A coarse motor encoder: what one count is, what rounding does to the noise, the low-pass and J_m."""

import numpy as np
import pytest

from rig.analysis.motion.smallest_step import smallest_step
from rig.analysis.tracing.runs.resolution import COARSE, SLOWEST, counts_of, noise_of, quiet, rough
from rig.analysis.tracing.thresholds import BANDWIDTH

COUNTS = 2000
COUNT = 2 * np.pi / COUNTS
DECLARED = {"motor_counts_per_rev": COUNTS}


def read(speed: float, count: float = COUNT) -> np.ndarray:
    """An encoder at `speed` rad/s, rows 2.4 ms apart."""
    return np.asarray(count * np.round((0.1 + speed * 2.4e-3 * np.arange(5000)) / count))


@pytest.mark.parametrize("speed", [0.5, 1.0, 7.0, 45.0])
def test_one_count_is_seen_at_any_speed(speed: float) -> None:
    assert smallest_step(read(speed)) == pytest.approx(COUNT, rel=1e-6)


def test_a_reading_that_stands_still_has_no_step() -> None:
    assert smallest_step(np.full(100, 3.0)) == 0.0


@pytest.mark.parametrize("counts", [2000, 65_536, 1_296_000])
def test_counts_nobody_declared_are_those_the_angle_is_whole_steps_of(counts: int) -> None:
    theta = read(1.0, 2 * np.pi / counts)
    assert counts_of(theta, 0.0) == pytest.approx(counts, rel=1e-6)
    assert counts_of(theta, 4096.0) == 4096.0
    assert counts_of(np.where(np.arange(theta.size) == 7, np.nan, theta), 0.0) in (0.0, pytest.approx(counts, rel=1e-6))


def test_an_angle_that_is_no_whole_steps_tells_no_counts() -> None:
    noisy = read(1.0) + 1e-3 * COUNT * np.random.default_rng(1).standard_normal(5000)
    assert counts_of(noisy, 0.0) == 0.0
    assert counts_of(np.full(100, 3.0), 0.0) == 0.0
    assert counts_of(None, 0.0) == 0.0


@pytest.mark.parametrize("speed", [0.5, 45.0])
def test_a_slow_coarse_encoder_is_as_noisy_as_its_rounding(speed: float) -> None:
    assert noise_of("theta_m", read(speed), DECLARED) == pytest.approx(COUNT / 12**0.5, rel=1e-6)


def test_an_encoder_finer_than_declared_has_the_noise_it_shows() -> None:
    fine = read(1.0, COUNT / 1000)
    assert noise_of("theta_m", fine, DECLARED) < COUNT / 500


def test_the_low_pass_is_lower_for_a_coarse_encoder_alone() -> None:
    assert quiet(read(1.0), DECLARED) == pytest.approx(BANDWIDTH / 5)
    assert quiet(read(1.0, 2 * np.pi / 42), {"motor_counts_per_rev": 42}) == SLOWEST  # Hall sensors
    fine = 8192
    assert 2 * np.pi / fine < COARSE
    assert quiet(read(1.0, 2 * np.pi / fine), {"motor_counts_per_rev": fine}) == BANDWIDTH
    assert quiet(read(1.0), {}) == BANDWIDTH
    assert quiet(None, DECLARED) == BANDWIDTH


@pytest.mark.parametrize("count", [1e-9, 4.85e-6, 2e-6])
def test_the_noise_of_a_reading_in_counts_is_known_to_a_tenth(rng: np.random.Generator, count: float) -> None:
    """A median of a handful of values was a quarter too high, and K without a torque sensor with it."""
    theta = 0.02 * np.arange(45_000) * 1e-3 + 1.5e-6 * rng.standard_normal(45_000)
    theta[20_000:] -= 5e-4  # a reversal, a jump
    read = count * np.round(theta / count)
    assert rough(read) == pytest.approx(np.hypot(1.5e-6, count / 12**0.5), rel=0.1)


def test_a_clock_that_is_early_and_late_is_no_noise_of_the_reading() -> None:
    """Stamped as it ticked: 20 % of a row off, at a speed that makes 0.2 mrad of it."""
    rng = np.random.default_rng(4)
    t = 1e-3 * (np.arange(20_000) + 0.2 * rng.standard_normal(20_000))
    clean = 0.84 * t + 1e-3 * np.sin(2 * np.pi * 13.0 * t)
    read = clean + 2e-6 * rng.standard_normal(t.size)
    assert rough(read, t) == pytest.approx(2e-6, rel=0.05)
    assert rough(read) > 30 * 2e-6
    assert noise_of("theta_l", read, {}, t) == rough(read, t)


def test_on_an_even_clock_both_ways_of_taking_differences_find_the_same_noise() -> None:
    read = np.random.default_rng(5).standard_normal(5000)
    assert rough(read, np.arange(5000.0)) == pytest.approx(rough(read), rel=1e-9)


def test_an_angle_that_was_commanded_and_turns_back_now_and_then_has_no_count() -> None:
    t = np.arange(0.0, 100.0, 0.004)
    assert smallest_step(25.13 * np.abs(4 * ((t / 50) % 1 - 0.5))) == 0.0
