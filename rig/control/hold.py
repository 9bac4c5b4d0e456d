"""The operator's hold (stop category 2): bring the motor to rest, then keep it where it came to, torque on."""

from __future__ import annotations

from rig.control.pid import Pid
from rig.control.profile import Ramp
from rig.control.spin import ACCELERATION
from rig.core.procedure import Setting, Steps
from rig.core.sample import Torque


def hold(setting: Setting) -> Steps:
    """θ_ref falls to rest from the speed there is, and stays. Ends only with what the operator asks for next."""
    pid = Pid(setting.control, setting.period)
    sample = yield Torque(0.0)
    # takes over the torque there is: whatever is wound up behind the motor goes on being held
    pid.take_over(sample.tau_m, sample.omega_m)
    ramp, home, begin = Ramp(sample.omega_m, 0.0, ACCELERATION), sample.theta_m, sample.t
    while True:
        offset, omega_ref = ramp.at(sample.t - begin)
        tau = pid.step(home + offset, omega_ref, sample.theta_m, sample.omega_m)
        sample = yield Torque(tau, home + offset, omega_ref)
