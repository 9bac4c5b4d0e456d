"""Whether it is known how far apart motor and load angle are latched, and what that means for a kinematic error."""

from __future__ import annotations

from rig.bench import Bench
from rig.core.units import ARCSEC, RPM
from rig.doctor.finding import Finding, Health

SLOW = 9.6  # rpm, the speed of a kinematic-error run      [ghorbel2001]


def check_latch_skew(bench: Bench) -> list[Finding]:
    """The load encoder's `skew` of the bench file; nothing without a load encoder."""
    section = bench.file.load_encoder
    if section is None:
        return []
    per_second = SLOW * RPM / bench.file.gear.N / ARCSEC  # arcsec at the output, each direction
    name = "latch skew of the load encoder"
    if section.skew is None or section.skew_half_width is None:
        period = 1.0 / bench.file.loop.rate
        would = f"one period of {period * 1e3:g} ms would move θ̃ by {period * per_second:.2g} arcsec at {SLOW:g} rpm"
        return [Finding(name, Health.DOUBTFUL, f"not measured (hdrig run skew): {would}")]
    told = f"{section.skew * 1e6:.3g} ± {section.skew_half_width * 1e6:.2g} µs after the motor angle"
    moves = f"moves θ̃ by {abs(section.skew) * per_second:.2g} ± {section.skew_half_width * per_second:.2g} arcsec"
    return [Finding(name, Health.GOOD, f"{told}, {moves} at {SLOW:g} rpm")]
