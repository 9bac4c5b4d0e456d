"""Every number that decides something in a trace, with its reason."""

from __future__ import annotations

from typing import Final

RATE: Final = 250.0  # Hz, faster runs are brought down to about this first: 15 orders at 400 rpm end at 100 Hz
BANDWIDTH: Final = 36.0  # Hz, standard deviation of the low-pass: J_m·ω̇ of a 16-bit encoder is then 1 mN·m of noise
SLOWEST_TURNING: Final = 0.1  # rad/s of the motor; below it friction is not sliding friction: a tenth of a slow run
SETTLING: Final = 0.15  # s left out of the torque equations on both sides of a reversal: presliding is over
