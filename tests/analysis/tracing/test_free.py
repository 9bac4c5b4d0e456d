"""The free simulation beside its floor: what rings there, what is said of it, and which part of a run is drawn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.fit.led import Model, rung
from rig.analysis.tracing.outcome.free import _one_way, together
from rig.analysis.tracing.outcome.free_told import free_told, over_floor
from rig.analysis.tracing.outcome.result import Before, Errors, Trace
from rig.model.effect import Known, parameter
from rig.model.fourier import FourierSeries
from tests.report.trace import made_up

GEAR = Known(K=7200.0, B_sp=5.0, J_m=1.5e-3, J_l=0.8, kinematic_error=FourierSeries((0.0,), (0.0,)))
MODEL = Model(GEAR, B_l=1.0, tau_cl=0.4, mesh=0.0, terms=())
DT = 0.008
REST = 0.045  # N·m


def test_a_steady_torque_winds_the_gear_up_and_one_at_the_resonance_by_its_quality_more() -> None:
    t = np.arange(1000) * DT
    np.testing.assert_allclose(rung(np.full(t.size, 0.5), DT, MODEL), -0.5 / GEAR.K)
    omega = np.sqrt(GEAR.K / GEAR.J_l)
    swing = rung(0.5 * np.sin(omega * t), DT, MODEL)[500:]
    quality = np.sqrt(GEAR.K * GEAR.J_l) / (GEAR.B_sp + MODEL.B_l)
    assert np.ptp(swing) / 2 == pytest.approx(0.5 / GEAR.K * quality, rel=0.1)  # straight lines between rows


def test_runs_count_alike_and_one_that_is_unknown_leaves_all_unknown() -> None:
    assert together([3.0, 4.0]) == pytest.approx(12.5**0.5)
    assert together([3.0, None]) is None
    assert together([]) is None


@pytest.mark.parametrize(
    ("turns", "rows"),
    [
        (np.linspace(0, 5, 51), 21),  # two turns of five
        (np.linspace(0, 1, 11), 11),  # a run that is shorter
        (np.concatenate([np.linspace(0, 1, 11), np.linspace(0.9, 0, 10)]), 10),  # it turns back after one
    ],
)
def test_a_line_is_drawn_until_two_turns_are_made_or_the_motor_turns_back(turns: np.ndarray, rows: int) -> None:
    assert _one_way(turns, 2.0) == rows


def simulated(error: float, by_load: float | None, tau_l: float | None = REST) -> Trace:
    base = made_up.explained()
    one = Errors(0.9, 0.002, tau_l, 0.9, 0.002, 0.06, error, by_load)
    stiff = (parameter("K", GEAR.K, 1.0, "N·m/rad"), parameter("J_l", GEAR.J_l, 0.001, "kg·m²"))
    return replace(base, baseline_after=stiff, after=Before({"fast": one}, base.after.pooled))


def test_above_the_floor_it_is_said_what_of_it_the_shaft_torque_makes_and_why_the_verdict_stands() -> None:
    said = free_told(simulated(2.7, 2.4))
    assert said["resonance_hz"] == pytest.approx(15.1, abs=0.05)
    assert said["sentence"].startswith("The free simulation stays at 3 times the floor. That does not speak against")
    assert "the 45 mN·m RMS that the shaft torque’s equation leaves make 2.4 arcsec" in said["sentence"]
    assert said["sentence"].endswith("most of what is above the floor.")


def test_noise_that_would_make_more_than_is_seen_is_not_called_a_part_of_it() -> None:
    assert free_told(simulated(2.7, 3.1))["sentence"].endswith("which is no less than what is seen.")


def test_what_noise_does_not_make_is_not_put_down_to_it() -> None:
    said = free_told(simulated(9.0, 2.4))["sentence"]
    assert "What is more than that are errors of the model" in said
    assert "most of what" not in said


def test_without_a_torque_sensor_no_share_is_claimed() -> None:
    said = free_told(simulated(2.7, None, None))["sentence"]
    assert "no torque sensor says" in said
    assert "read the shaft torque" not in said


def test_a_verdict_that_something_is_missing_is_not_defended() -> None:
    trace = simulated(2.7, 2.4)
    said = free_told(replace(trace, verdict=replace(trace.verdict, status=Status.UNKNOWN)))["sentence"]
    assert "does not speak against" not in said


def test_at_the_floor_and_where_nothing_was_simulated_nothing_is_said() -> None:
    assert free_told(simulated(1.0, 0.5))["sentence"] == ""
    assert free_told(made_up.explained()) == {"resonance_hz": None, "sentence": ""}
    assert over_floor(made_up.explained().after.pooled) is None
