"""What is known of the gear while effects are looked for: the baseline as fitted so far."""

from __future__ import annotations

from dataclasses import dataclass

from rig.model.fourier import FourierSeries


@dataclass(frozen=True)
class Known:
    """The baseline as fitted so far: what columns may lean on. SI."""

    K: float
    B_sp: float
    J_m: float
    J_l: float
    kinematic_error: FourierSeries
    tau_c: float = 0.0  # N·m and N·m·s/rad, the motor's friction
    B_m: float = 0.0
    tau_cl: float = 0.0  # N·m and N·m·s/rad, the load's, of a torque that nobody read
    B_l: float = 0.0
    torque_zero: float = 0.0  # N·m, what the torque sensor reads without torque; `torque` is without it

    @property
    def damped_for(self) -> float:
        """B_sp/K, s, by which the spring follows a torque late that the damper beside it takes at first; 0 while it is
        not known."""
        return max(self.B_sp / self.K, 0.0)
