"""Which channels have gone silent while nothing runs: what they told last is no present value."""

from __future__ import annotations

from typing import final

from rig.core.channels import Flag
from rig.core.sample import NAN, Sample

LONGEST = 0.5  # s without news; a reading is taken every 50 ms, and devices that are asked answer after the next
MOTOR, LOAD, TORQUE = int(Flag.STALE_M), int(Flag.STALE_L), int(Flag.STALE_TAU)


@final
class Silence:
    """Fed with every idle reading. On a clock that stands still, as the virtual one does, nothing grows old."""

    def __init__(self) -> None:
        self._heard: dict[int, float] = {}  # s, when a channel was last news
        self._looked = 0.0  # s, the reading before

    def hear(self, sample: Sample, now: float) -> Sample:
        """The reading without the values of channels that were not heard for too long: not measured is NaN."""
        if now - self._looked > LONGEST:  # nobody listened while a job was carried out: nobody is silent yet
            self._heard.clear()
        self._looked = now
        motor, load, torque = (self._silent(stale, sample, now) for stale in (MOTOR, LOAD, TORQUE))
        if motor:
            sample = sample._replace(theta_m=NAN, omega_m=NAN, tau_m=NAN)
        if load:
            sample = sample._replace(theta_l=NAN)
        return sample._replace(tau_l=NAN) if torque else sample

    def _silent(self, stale: int, sample: Sample, now: float) -> bool:
        """A channel that was never news counts from the first reading."""
        if not sample.flags & stale:
            self._heard[stale] = now
        return now - self._heard.setdefault(stale, now) > LONGEST
