"""What no strain-wave gear on sale does: what is beyond is nearly always a unit read wrongly."""

from __future__ import annotations

from typing import Final

PERIOD: Final = (9e-6, 0.5)  # s: above 111 Hz stamped in s and read as ms; up to 2 kHz stamped in ms and read as s
TORQUE: Final = {"tau_m": 300.0, "tau_l": 20_000.0, "tau_ask": 300.0, "tau_applied": 300.0}
"""N·m: twice the peak of a size 100."""
