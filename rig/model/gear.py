"""The parameters of equations 5-7, as one value."""

from __future__ import annotations

from dataclasses import dataclass

from rig.model.fourier import FourierSeries

SIGMA = {"flexspline": 1, "circular_spline": 0}
"""σ of Eqs. 6-7 by the part that is the output, named as in bench files, manifests and gear files."""
USUAL = "flexspline"  # the output where nobody named one


def output_of(said: object) -> str:
    """The part that is the output, as a manifest names it; the usual one where it names none that exists."""
    return said if isinstance(said, str) and said in SIGMA else USUAL


def sigma_of(said: object) -> int:
    """σ of Eqs. 6-7 for the output a manifest, a bench file or a gear file names."""
    return SIGMA[output_of(said)]


@dataclass(frozen=True)
class Gear:
    """The two-inertia rig of the paper: motor and wave generator, flexible gear, load      [ghorbel2001, Eqs. 3-8]

    SI; `_m` motor side, `_l` load side. The paper leaves friction out of Eqs. 6-7; it stands here as the rig has it.
    """

    ratio: float  # N, motor turns per load turn
    J_m: float  # kg·m², motor rotor, wave generator, coupling half
    J_l: float  # kg·m², load disc and shaft
    K: float  # N·m/rad, torsional stiffness seen at the load
    B_m: float  # N·m·s/rad
    B_l: float  # N·m·s/rad
    B_ml: float  # N·m·s/rad, wave generator against flexspline
    B_sp: float  # N·m·s/rad, damping of the torsional spring
    kinematic_error: FourierSeries
    sigma: int = (
        1  # +1: flexspline is the output, it turns against the wave generator; 0: circular spline is the output
    )
    tau_c: float = 0.0  # N·m, Coulomb friction, motor side
    tau_s: float = 0.0  # N·m, breakaway torque, motor side
    omega_s: float = 1.0  # rad/s, Stribeck speed, motor side
    F_cl: float = 0.0  # N·m, Coulomb friction, load side

    @property
    def viscous(self) -> float:
        """Damping seen at the motor when all turns together [N·m·s/rad]: B_m + B_ml·(1 + σ/N)² + B_l/N²."""
        return self.B_m + self.B_ml * (1.0 + self.sigma / self.ratio) ** 2 + self.B_l / self.ratio**2
