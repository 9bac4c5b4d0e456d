"""Units that people read, in SI: times one of them goes in, divided by it comes out."""

from __future__ import annotations

import math
from typing import Final

TURN: Final = 2.0 * math.pi  # rad
DEG: Final = math.pi / 180.0  # rad
ARCMIN: Final = DEG / 60.0
ARCSEC: Final = DEG / 3600.0
RPM: Final = math.pi / 30.0  # rad/s
