"""A lock test without a torque sensor: its torque is what the spring makes of the wind-up, and the motor holds it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rig.analysis.tracing.fit.footprint import footprint
from rig.analysis.tracing.runs.smoothing import Smoother
from rig.analysis.tracing.runs.wound import wound
from rig.model.effect import MEASURED, Known, Port
from rig.model.fourier import FourierSeries
from tests.contract.test_effects import motion

N, K, DT = 50.0, 7000.0, 4e-3
GEAR = Known(K=K, B_sp=0.0, J_m=1e-3, J_l=0.5, kinematic_error=FourierSeries((0.0, 2e-4), (1e-4, 0.0)))
NONE = FourierSeries((), ())
FRICTION, CLAMP = 0.5, 3e-4  # N·m; rad by which the clamp turned the output


def swung(rng: np.random.Generator, stiffness: float = K) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """T, θ_m, θ_l and τ_m of three swings up to 40 N·m."""
    t = DT * np.arange(6000)
    torque = 40.0 * np.sin(2 * np.pi * t / 8.0)
    theta_m = N * torque / stiffness
    theta_m = N * (torque / stiffness + GEAR.kinematic_error.value(theta_m))
    theta_l = np.full(t.size, -CLAMP)
    lever = 1 / N - GEAR.kinematic_error.slope(theta_m)
    tau_m = torque * lever + FRICTION * np.sign(np.cos(2 * np.pi * t / 8.0)) + 2e-3 * rng.standard_normal(t.size)
    return torque, theta_m, theta_l, tau_m


def test_the_wind_up_tells_the_torque_and_its_zero_is_where_the_motor_holds_nothing(rng: np.random.Generator) -> None:
    torque, *read = swung(rng)
    told = wound(*read, N, GEAR, DT)
    assert told
    assert pytest.approx(K, rel=2e-3) == told.K
    assert told.torque == pytest.approx(torque, abs=0.1)


def test_a_spring_that_hardens_by_a_quarter_tells_the_torque_that_effects_go_by(rng: np.random.Generator) -> None:
    wound_up = np.linspace(-40.0, 40.0, 4001) / K
    torque, *read = swung(rng)
    hardening = 0.25 * K / wound_up[-1] ** 2  # N·m/rad³
    phi = np.interp(torque, K * wound_up + hardening * wound_up**3, wound_up)
    read[0] = N * (phi + GEAR.kinematic_error.value(read[0]))
    told = wound(*read, N, GEAR, DT)
    assert told
    assert told.bent == pytest.approx(torque, abs=0.25)
    assert np.abs(told.torque - torque).max() > 1.0, "a straight one does not"
    assert told.local == pytest.approx(K + 3 * hardening * phi**2, rel=0.04)


@pytest.mark.parametrize(("stiffness", "told"), [(K / 5, False), (K / 1.2, True), (1.2 * K, True), (5 * K, False)])
def test_a_spring_that_was_declared_a_little_off_is_told_as_it_is_and_another_is_none(
    rng: np.random.Generator, stiffness: float, told: bool
) -> None:
    _, *read = swung(rng, stiffness)
    found = wound(*read, N, GEAR, DT)
    assert (found is not None) is told
    assert found is None or pytest.approx(stiffness, rel=5e-3) == found.K


def test_a_motor_that_rests_or_whose_torque_was_not_read_tells_nothing(rng: np.random.Generator) -> None:
    _, theta_m, theta_l, tau_m = swung(rng)
    assert wound(0 * theta_m, 0 * theta_l, tau_m, N, GEAR, DT) is None
    assert wound(theta_m, theta_l, np.full(tau_m.size, np.nan), N, GEAR, DT) is None
    assert wound(theta_m, theta_m / N, tau_m, N, replace(GEAR, kinematic_error=NONE), DT) is None, "one angle, twice"


def test_the_motor_holds_what_the_wind_up_gains_and_the_clamp_what_acts_on_the_load() -> None:
    s = replace(motion(), gear=GEAR)
    smooth = Smoother(20.0, s.dt, 1)
    column = np.sin(s.t)[:, None]

    def shown(port: Port) -> dict[str, np.ndarray]:
        return footprint({port: column}, s, smooth, MEASURED - {"tau_l"}, is_wound=True)

    lever = (1 / s.ratio - GEAR.kinematic_error.slope(s.theta_m))[:, None]
    assert shown(Port.WIND_UP)["M"] == pytest.approx(-K * smooth(lever * column), rel=1e-3)
    assert set(shown(Port.LOAD_TORQUE)) <= {"L"}
    assert shown(Port.READS_TAU_L)["M"] == pytest.approx(0.0, abs=1e-12), "a sensor that is not there has no error"
