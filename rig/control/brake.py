"""The controlled stop (category 1): bring the motor to rest, then the loop takes the torque off."""

from __future__ import annotations

from rig.core.procedure import Setting, Steps
from rig.core.sample import Torque

AT_REST = 0.05  # rad/s, half a rpm: friction holds from here
REST_TIME = 0.05  # s it has to stay there
PATIENCE = 2.0  # s; a motor that will not come to rest is let go, its friction does the rest
SHARE = 0.5  # of the torque limit, so that braking itself cannot trip anything


def brake(setting: Setting) -> Steps:
    """τ = −K_d·ω within half the torque limit until the motor rests."""
    gains = setting.control
    limit = SHARE * gains.torque_limit
    quiet, waited = 0.0, 0.0
    sample = yield Torque(0.0)
    while quiet < REST_TIME and waited < PATIENCE:
        quiet = quiet + setting.period if abs(sample.omega_m) < AT_REST else 0.0
        waited += setting.period
        sample = yield Torque(max(-limit, min(limit, -gains.Kd * sample.omega_m)))
