"""What the spring holds of the shaft torque: a spring and a damper side by side, wound up at a known pace."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from rig.model.effect import Known, Signals
from rig.model.fourier import FourierSeries

K, B_SP, N = 7000.0, 8.0, 50.0
DT = 1e-3
PURE = FourierSeries((3e-5, -2e-4), (1e-5, 1e-4))


def wound_up() -> tuple[Signals, np.ndarray]:
    """A motor at 120 rpm while the load lags behind by φ = 0.3 mrad · sin(2π·4 Hz·t); and what the spring holds."""
    t = DT * np.arange(2000)
    phi, rate = 3e-4 * np.sin(8 * np.pi * t), 3e-4 * 8 * np.pi * np.cos(8 * np.pi * t)
    omega = np.full(t.size, 4 * np.pi)
    theta_m = omega * t
    slope = PURE.slope(theta_m)
    omega_l = omega / N - slope * omega - rate
    nothing = np.zeros(t.size)
    torque = K * phi + B_SP * rate
    made = Signals(
        t=t, dt=DT, ratio=N, theta_m=theta_m, theta_l=theta_m / N - PURE.value(theta_m) - phi, omega_m=omega,
        alpha_m=nothing, omega_l=omega_l, alpha_l=nothing, torque=torque,
        torque_rate=np.gradient(torque, DT), tau_m=nothing, tau_l=torque, tau_ext=nothing, way=nothing + 1.0,
        temperature=nothing * np.nan, gear=Known(K, B_SP, 1e-3, 0.5, PURE),
    )  # fmt: skip
    return made, K * phi


def test_the_damper_is_taken_off():
    s, held = wound_up()
    np.testing.assert_allclose(s.spring_torque, held, atol=1e-9)


@pytest.mark.parametrize("missing", ["theta_l", "theta_m"])
def test_with_one_angle_the_torque_tells_the_pace(missing: str):
    s, held = wound_up()
    lone = dataclasses.replace(
        s, **({"omega_l": s.omega_m / N} if missing == "theta_l" else {"omega_m": s.omega_l * N})
    )
    off = np.abs(lone.spring_torque - held)[10:-10]
    assert off.max() < 0.03 * B_SP * 3e-4 * 8 * np.pi  # a spring of 7000 N·m/rad whose damper lags by 1.1 ms
