"""From a bench file to the plant of the twin."""

from __future__ import annotations

from typing import Any

from rig.config.bench_file import BenchFile
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear, sigma_of


def twin_parameters(f: BenchFile) -> Any:
    """The numbers of the bench file as the twin wants them."""
    import numpy as np

    from sim.effects import Effects
    from sim.parameters import TwinParameters

    twin, gear = f.twin, f.gear
    assert twin is not None
    error = FourierSeries.from_polar(np.radians(twin.kinematic_error.C_deg), np.radians(twin.kinematic_error.psi_deg))
    model = Gear(
        ratio=gear.N, J_m=gear.J_m, J_l=gear.J_l, K=gear.K, B_m=gear.B_m, B_l=gear.B_l, B_ml=gear.B_ml, B_sp=gear.B_sp,
        kinematic_error=error, sigma=sigma_of(gear.output),
        tau_c=twin.tau_c, tau_s=twin.tau_s, omega_s=twin.omega_s, F_cl=twin.F_cl,
    )  # fmt: skip
    return TwinParameters(
        gear=model,
        friction_noise=twin.friction_noise,
        friction_noise_s=twin.friction_noise_s,
        tau_drive=twin.tau_drive,
        torque_limit=f.motor.torque_limit,
        torque_resolution=twin.torque_resolution,
        torque_noise=twin.torque_noise,
        watchdog=twin.watchdog,
        motor_counts_per_turn=f.motor.counts_per_turn,
        load_counts_per_turn=f.load_encoder.counts_per_turn if f.load_encoder else 1,
        sensor_range=f.torque_sensor.range if f.torque_sensor else 1.0,
        sensor_noise=twin.sensor_noise,
        sensor_zero=twin.sensor_zero,
        sensor_lowpass_hz=twin.sensor_lowpass_hz,
        sensor_resolution=twin.sensor_resolution,
        latch_m=twin.latch_m,
        latch_l=twin.latch_l,
        latch_tau=twin.latch_tau,
        effects=Effects.of(twin.effects.model_dump()),
    )
