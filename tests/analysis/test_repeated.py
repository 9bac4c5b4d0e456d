"""Readings that were not taken anew are missing, and named; what rests, sticks or is merely coarse is not."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis import analyse
from rig.analysis.motion.repeated import FAR, repeated
from rig.core.units import TURN
from tests.analysis.synthetic import MadeRun, slow_run

T = np.arange(60_000) / 1000.0
MOTOR = 40.0 * np.sin(TURN * T / 60.0) + 100.0 * T / 60.0  # rad, with a reversal
COUNT = TURN / 1_296_000


def load(noise: float = 1.5e-6, count: float = COUNT) -> np.ndarray:
    """The output's angle in counts [rad]."""
    rough = MOTOR / 50.0 + noise * np.random.default_rng(3).standard_normal(T.size)
    return np.asarray(np.round(rough / count) * count)


@pytest.mark.parametrize("noise", [0.0, 1.5e-6, 2e-5])
@pytest.mark.parametrize("count", [COUNT, 20 * COUNT, 400 * COUNT])
def test_a_coarse_or_noisy_reading_is_taken_anew(noise: float, count: float) -> None:
    assert repeated(load(noise, count), MOTOR, FAR).rows.size == 0
    assert repeated(MOTOR, load(noise, count), FAR / 50).rows.size == 0


def test_a_locked_output_rests() -> None:
    assert repeated(np.zeros(T.size), 0.1 * np.sin(T), FAR).rows.size == 0


def test_a_locked_output_rests_while_the_motor_winds_it_up_both_ways() -> None:
    """At ±100 N·m it goes 1.4 rad to and fro, and no load encoder hangs."""
    assert repeated(np.zeros(T.size), 0.7 * np.sin(TURN * T / 30.0), FAR).rows.size == 0


def test_a_motor_that_dwells_is_read_anew() -> None:
    stairs = np.interp(
        T, *zip(*((2.0 * i + dt, 3.0 * i + up) for i in range(30) for dt, up in ((0, 0), (1, 3))), strict=True)
    )
    assert repeated(stairs, stairs / 50.0, FAR).rows.size == 0


def test_an_angle_that_stands_while_the_other_side_turns_is_missing() -> None:
    x = load()
    stood = slice(3000, 8000)
    x[stood] = x[stood.start]
    found = repeated(x, MOTOR, FAR)
    assert (
        set(range(stood.start + 1, stood.stop)) <= set(found.rows.tolist()) <= set(range(stood.start, stood.stop + 9))
    )
    assert "theta_l stood for 5 s at t = 3.000 s" in found.words("theta_l", T)
    assert repeated(x, None, FAR).rows.size == 0, "nothing says that the shaft turned"


@pytest.mark.parametrize("share", [0.4, 0.6, 0.8])
def test_an_angle_that_stands_to_the_end_while_the_other_side_goes_there_and_back_is_missing(share: float) -> None:
    """A motor encoder that died after half of a run, in which the load came back to where it was: nothing was said."""
    x, there_and_back = MOTOR.copy(), 40.0 * np.sin(TURN * 5 * T / 60.0)
    stood = round((1 - share) * T.size)
    x[stood:] = x[stood]
    found = repeated(x, there_and_back / 50.0, FAR / 50)
    assert set(range(stood + 1, T.size)) <= set(found.rows.tolist())
    assert f"theta_m stood for {share * 60:.3g} s" in found.words("theta_m", T)


@pytest.mark.parametrize("every", [2, 4, 20])
def test_readings_of_a_sensor_slower_than_the_rows_count_once(every: int) -> None:
    x = load(count=COUNT / 20)
    x[:] = np.repeat(x[::every], every)
    rows = repeated(x, MOTOR, FAR).rows
    assert np.mean(rows % every == 0) < 0.01, "the first of them is new, but for two alike by chance"
    assert rows.size > 0.9 * T.size * (1 - 1 / every)


def test_a_frozen_encoder_moves_no_figure_and_is_said() -> None:
    run = slow_run(1)
    names = [n for n in ("t", "theta_m", "theta_l", "theta_ref", "tau_m", "tau_l", "flags") if run.has(n)]
    columns = {n: np.array(run.column(n)) for n in names}
    columns["theta_l"][36_000:41_000] = columns["theta_l"][36_000]
    frozen = MadeRun(columns, dict(run.manifest))
    whole, found = (
        next(e for e in analyse(r).estimates if e.name == "kinematic_error_peak_to_peak") for r in (run, frozen)
    )
    assert found.ci95[0] - 0.5 < whole.value < found.ci95[1] + 0.5
    assert any("theta_l stood for 5 s at t = 36.000 s" in note for note in analyse(frozen).cannot)


def test_a_motor_that_sticks_and_slips_is_read_anew() -> None:
    stuck = 0.05 * np.floor(T / 0.1)  # 0.05 rad ten times a second
    assert repeated(stuck, stuck / 50.0, FAR).rows.size == 0
    assert repeated(stuck / 50.0, stuck, FAR).rows.size == 0


def test_a_motor_that_sticks_beside_a_locked_output_is_read_anew() -> None:
    stuck = 0.05 * np.floor(T / 0.1)
    held = 1.5e-6 * np.random.default_rng(4).standard_normal(T.size)
    assert all(repeated(stuck, held * scale, FAR / 50).rows.size == 0 for scale in (1.0, -1.0))


def test_a_wrapped_motor_that_rests_where_it_wraps_has_not_turned() -> None:
    noise = 1e-4 * np.random.default_rng(5).standard_normal(T.size)
    noise[0], noise[-1] = -1e-4, 1e-4
    assert repeated(np.full(T.size, 0.3), np.mod(noise, TURN), FAR).rows.size == 0
