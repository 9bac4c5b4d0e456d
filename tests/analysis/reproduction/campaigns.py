"""Campaigns made of formulas: a slow run, runs at speed by linear theory, slow runs under load, the gear itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np

from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.model import Model
from rig.analysis.reproduction.reading import Reading, reading_of
from rig.analysis.reproduction.shaft import Shaft
from rig.analysis.reproduction.split import Split, split_of
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear
from rig.model.gearfile import MeasuredSeries, Parameter
from rig.model.linear import transmissibility
from tests.analysis.synthetic import ARCSEC, PROFILE, TURN, MadeRun, count, slow_run, wander

GEAR = Gear(50.0, 1.1e-3, 0.32, 7160.0, 5e-4, 0.5, 2.5e-3, 3.6, PROFILE)
DECLARED = {"J_m": 1.1e-3, "J_l": 0.32, "K": 7160.0, "B_sp": 3.6}
RPM = np.pi / 30.0


def scaled(kept: float) -> FourierSeries:
    """θ̃_p with `kept` of its size."""
    return FourierSeries(tuple(kept * a for a in PROFILE.a), tuple(kept * b for b in PROFILE.b))


@cache
def slow(
    kept: float = 1.0, load: float = 0.0, depth_mm: float = 0.0, assembly: int = 1, hertz: float = 0.01
) -> Reading:
    """One cycle of the triangle with `kept` of the error."""
    conditions = {"tau_ext": load, "depth_mm": depth_mm, "assembly": assembly}
    manifest = {"declared": DECLARED, "gear": {"ratio": 50.0}, "conditions": conditions}
    seed = int(100 * load) + assembly
    made = slow_run(seed, rate=250.0, cycles=1, frequency=hertz, profile=scaled(kept), manifest=manifest)
    return reading_of(replace(made, name=f"slow-{load:g}-{assembly}"))


@cache
def fast(rpm: float, gear: Gear = GEAR) -> Reading:
    """60 turns whose θ̃ is the pure one times the linear transmissibility of `gear`, and the torque that bends it."""
    omega, dt, rng = rpm * RPM, 1e-3, np.random.default_rng(5)
    t = np.arange(int(60.5 * TURN / omega / dt)) * dt
    theta = omega * t
    pure = np.asarray(PROFILE.a) - 1j * np.asarray(PROFILE.b)
    z = pure * transmissibility(gear, PROFILE.orders, omega)
    error = FourierSeries(tuple(z.real), tuple(-z.imag)).value(theta) + wander(rng, t.size, dt, 0.3, 0.3 / ARCSEC)
    bend = (z - pure) * (gear.K + 1j * PROFILE.orders * omega * gear.B_sp)
    torque = FourierSeries(tuple(bend.real), tuple(-bend.imag)).value(theta) + 1.0
    columns = {
        "t": t,
        "theta_m": count(theta, 10_000),
        "theta_l": count(theta / 50.0 - error, 900_000),
        "tau_l": torque,
    }
    base = {"procedure": "constant_torque", "gear": {"ratio": 50.0}, "status": "completed", "declared": DECLARED}
    return reading_of(MadeRun(columns, base, f"fast-{rpm:g}"))


def model(gear: Gear = GEAR, held_out: bool = True) -> Model:
    """As if it had been identified without doubt."""
    parameters = {"K": Parameter(gear.K, (gear.K - 10, gear.K + 10)), "tau_c": Parameter(0.3, (0.29, 0.31))}
    series = MeasuredSeries(gear.kinematic_error, np.zeros((30, 30)))
    return Model(gear, parameters, series, ("friction", "lock"), held_out, ())


def campaign(readings: Sequence[Reading], gear: Gear | None = GEAR) -> Campaign:
    """With a model of `gear`."""
    return Campaign(readings, None if gear is None else model(gear), "" if gear else "nothing to identify from")


def split(rpm: float, gear: Gear = GEAR) -> Split:
    """The run at `rpm` of the true gear beside the model of `gear`."""
    found = split_of(campaign([slow(), fast(rpm)], gear), rpm)
    assert found is not None
    return found


def without_torque(reading: Reading) -> Reading:
    """As recorded without a torque sensor."""
    return replace(reading, shaft=None)


def with_torque_times(reading: Reading, factor: float) -> Reading:
    """As recorded by a torque sensor of another gain."""
    assert reading.shaft is not None
    s = reading.shaft
    return replace(reading, shaft=Shaft(s.orders * factor, s.u * factor, s.revolutions, s.mean, s.mean_size, s.swing))
