"""The three equations of the rig as linear regressions: what each says of a run, and by which columns.

With θ̃ = θ_m/N − θ_l, the shaft torque T and the paper's θ̃_p      [ghorbel2001, Eqs. 1, 6-8]

    A (rad)  θ̃ = c_0 + θ̃_p(θ_m) + T/K − (B_sp/K²)·Ṫ + (B_sp²/K³)·T̈ + (B_ml/K)·ω_m
    M (N·m)  τ_m − T/N = τ_0 − T·θ̃_p′(θ_m) + J_m·ω̇_m + B_m·ω_m + τ_c·sgn ω_m
    R        M where the motor has just turned back, or soon will: friction that builds up over milliradians
    L (N·m)  T + τ_ext = J_l·ω̇_l + B_l·ω_l + τ_cl·sgn ω_l + z

Where they are looked for (runs/look.py) M has g·T/N too, the share by which the motor's torque reads more than the
sensor, and −δ_m·τ̇_m of a motor's torque that is read δ_m late, or early.

T = r + δ·ṙ of the reading r: every torque sensor has a low-pass of its own, 0.16 ms for one of 1 kHz, and at 500 rpm a
tenth of a millisecond stands above the noise of L. The torque sensor's zero z wanders from run to run, and c_0 may: how
far is read from repeats. B_ml shows in
A only when the torque sensor sits behind the mesh's own drag; it is known to be small.

A sensor that is not there takes one equation away, and what it would have said is put into the others:

no torque sensor   T = J_l·ω̇_l − τ_ext from L with the inertia declared, and what else L says stands in A and M;
                   of a locked output T = K·(θ̃ − θ̃_p), and what else A says stands in M
no load angle      θ_l = θ_m/N − θ̃ from A, in L: J_l·(ω̇_m/N − d²θ̃/dt²)
no motor angle     θ_m = N·(θ_l + θ̃) from A, in M: J_m·N·(ω̇_l + d²θ̃/dt²)
one side unread    in M, orders that this side answers by its resonance are each run's own (runs/answered.py)
no time            rows have no known distance: whatever is a rate belongs to each run alone
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, NamedTuple

from rig.model.fourier import PAPER_ORDERS

ORDERS: Final = PAPER_ORDERS  # terms of θ̃_p      [ghorbel2001, Eq. 8]


class Channel(NamedTuple):
    """What one of the equations says: the sensor's column it is compared in, by which key a trace tells of it, what
    that is in words, and its unit."""

    sensor: str
    key: str
    name: str
    unit: str


AT_REVERSALS: Final = "tau_m_at_reversals"  # beside the sensors' names: the motor torque where the motor turns back
CHANNEL: Final = {
    "A": Channel("theta_l", "theta_l", "kinematic error", "rad"),
    "M": Channel("tau_m", "tau_m", "motor torque", "N·m"),
    "R": Channel("tau_m", AT_REVERSALS, "motor torque at reversals", "N·m"),
    "L": Channel("tau_l", "tau_l", "shaft torque", "N·m"),
}
"""By letter."""
CHANNELS: Final = tuple(CHANNEL)
WHOLE: Final = ("A", "M", "L")
"""Those that hold all along a run; R is M where the motor has just turned back."""
SENSOR_NAMES: Final = {CHANNEL[c].key: CHANNEL[c].name for c in WHOLE}
"""What is compared in each sensor, in words."""
SERIES: Final = tuple(f"{c}{n}" for n in range(1, ORDERS + 1) for c in "ab")
BASELINE: Final = (
    *SERIES,
    "compliance",
    "damping",
    "damping_2",
    "mesh",
    "c_0",
    "J_m",
    "B_m",
    "tau_c",
    "tau_0",
    "J_l",
    "B_l",
    "tau_cl",
    "tau_l0",
    "lag",
    "gain",
    "inertia",
    "lag_m",
)
INDEX: Final = {name: i for i, name in enumerate(BASELINE)}
RATES: Final = frozenset({"damping", "damping_2", "mesh", "J_m", "B_m", "J_l", "B_l", "lag", "inertia", "lag_m"})
"""Coefficients of derivatives by time."""
WIND_UP: Final = ("compliance", "damping", "damping_2")
"""Of the spring, in A."""
NEEDS: Final[Mapping[str, frozenset[str]]] = {
    "A": frozenset({"theta_m", "theta_l"}),
    "M": frozenset({"tau_m"}),
    "R": frozenset({"tau_m", "theta_m", "tau_l", "t"}),
    "L": frozenset({"tau_l"}),
}
"""What has to be measured for a channel."""
