"""Orders a motor's torque may ripple with, cycles per turn: what cogging and current ripple are sought at."""

from __future__ import annotations

from typing import Final

HIGHEST: Final = 60  # LCM(slots, poles) of common servo motors: 12 to 60
HARMONICS: Final = (66, 72, 78, 84, 90, 96, 108, 120)  # of those: three phases make sixes
MOTOR_ORDERS: Final = (*range(1, HIGHEST + 1), *HARMONICS)
