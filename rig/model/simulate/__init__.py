"""Equations 6-7 solved: steady turning at constant torque, and motion under a recorded torque or motor angle.

Written apart from the twin's plant, which steps explicitly through time: the steady state is a Fourier collocation over
the motor angle, the load under a known motor motion is propagated exactly, and the motion under a torque is a Newmark
march in the coordinates (θ_m, φ). Agreement of the two is a test, not an assumption. `each_under_torque` is that motion
for a thousand gears at once.
"""

from rig.model.simulate.forced import under_motion
from rig.model.simulate.march import Motion, Start, under_torque
from rig.model.simulate.steady import at_speed, steady_state, torque_for
from rig.model.simulate.sweep import Swept, each_under_torque
from rig.model.simulate.waveform import NoSteadyState, Waveform

__all__ = [
    "Motion",
    "NoSteadyState",
    "Start",
    "Swept",
    "Waveform",
    "at_speed",
    "each_under_torque",
    "steady_state",
    "torque_for",
    "under_motion",
    "under_torque",
]
