"""How far the kinematic error is expected to swing the shaft torque at a speed, from the declared gear."""

from __future__ import annotations

from functools import lru_cache

from rig.bench import Bench
from rig.core.procedure import Envelope
from rig.core.units import ARCMIN, RPM
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear
from rig.model.linear import natural_frequency
from rig.model.resonance import worst_swing

ORDER = 2  # the wave generator is an ellipse: twice a turn is what it does most
CLEAR = 0.85  # of the resonance's speed: nearer, a run would swing over 3.6 times as far as its spring alone lets it
ORDER_2 = 1.0 * ARCMIN  # rad, zero to peak: twice what a catalogue's 1 arcmin peak to peak can hold, as in plans


def resonance_speed(gear: Gear) -> float:
    """Motor speed [rad/s] at which order 2 meets the torsional mode."""
    return natural_frequency(gear) / ORDER


@lru_cache(maxsize=1000)  # a plan repeats its speeds
def swing(gear: Gear, amplitude: float, omega_m: float) -> float:
    """The largest shaft torque swing [N·m, zero to peak] of order 2 on the way from rest to `omega_m` rad/s.

    `amplitude` C_2 of the pure kinematic error, rad at the output; its phase does not matter.
    """
    return worst_swing(gear, FourierSeries((0.0, amplitude), (0.0, 0.0)), omega_m)[0] if omega_m else 0.0


def into_resonance(bench: Bench, envelope: Envelope, amplitude: float) -> str:
    """What happens on the way to its speed on a free output, in words; "" where it stays clear of the resonance."""
    gear = bench.declared_gear
    at, speed = resonance_speed(gear), envelope.speed
    if speed <= CLEAR * at:
        return ""
    reserve = f" ({envelope.reserve})" if envelope.reserve else ""
    return (
        f"order 2 meets the torsional resonance at {at / RPM:.0f} rpm of the motor, this run may reach "
        f"{speed / RPM:.0f} rpm{reserve}, and on the way the shaft torque is expected to swing by "
        f"±{swing(gear, amplitude, speed):.1f} N·m; expected a run that stays below {CLEAR * at / RPM:.0f} rpm"
    )


def predicted(bench: Bench, speed: float, amplitude: float) -> str:
    """The line of a dry run: how far order 2 is expected to swing the shaft torque up to `speed` rad/s."""
    gear = bench.declared_gear
    most = swing(gear, amplitude, speed)
    told = f"±{most:.2f} N·m at most" if most >= 0.01 else "less than ±0.01 N·m"
    return (
        f"predicted   the shaft torque swings by {told}, from the declared "
        f"gear (order 2 resonates at {resonance_speed(gear) / RPM:.0f} rpm of the motor) and {amplitude / ARCMIN:g} "
        "arcmin of order 2, zero to peak"
    )
