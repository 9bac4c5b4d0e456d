"""How far the kinematic error is expected to swing the shaft torque at a speed, from the declared gear."""

from __future__ import annotations

import math
from functools import lru_cache

from rig.bench import Bench
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear
from rig.model.linear import natural_frequency
from rig.model.resonance import worst_swing

ORDER = 2  # the wave generator is an ellipse: twice a turn is what it does most
CLEAR = 0.85  # of the resonance's speed: nearer, a run would swing over 3.6 times as far as its spring alone lets it
ARCMIN = math.pi / 180 / 60


def declared_gear(bench: Bench) -> Gear:
    """The bench's gear without its kinematic error, which nobody declares."""
    g = bench.file.gear
    sigma = 1 if g.output == "flexspline" else 0
    return Gear(g.N, g.J_m, g.J_l, g.K, g.B_m, g.B_l, g.B_ml, g.B_sp, FourierSeries((), ()), sigma)


def resonance_speed(gear: Gear) -> float:
    """Motor speed [rad/s] at which order 2 meets the torsional mode."""
    return natural_frequency(gear) / ORDER


@lru_cache(maxsize=1000)  # a plan repeats its speeds
def swing(gear: Gear, amplitude: float, omega_m: float) -> float:
    """The largest shaft torque swing [N·m, zero to peak] of order 2 on the way from rest to `omega_m` rad/s.

    `amplitude` C_2 of the pure kinematic error, rad at the output; its phase does not matter.
    """
    return worst_swing(gear, FourierSeries((0.0, amplitude), (0.0, 0.0)), omega_m)[0] if omega_m else 0.0
