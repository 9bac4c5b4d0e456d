"""Numbers of a trace for people: three digits with their zeros, and units with a prefix where values are small."""

from __future__ import annotations

import math

from rig.core.units import ARCSEC
from rig.model.effect import Parameter
from rig.report.numbers import ABSENT, estimate, fixed, plain

MILLI = {"N·m": "mN·m", "N·m·s/rad": "mN·m·s/rad", "kg·m²": "g·m²", "s": "ms"}
FINE = 0.01  # rad; smaller angles are errors, which people read in arcsec, larger ones phases
WILD = 1e6  # half an interval over the value or one SI unit, from which a fit has not seen the parameter at all
SMALL = 0.1  # below it the prefix saves the reader from counting zeros


def three(value: float | None) -> str:
    """Three significant digits, zeros kept, so that columns line up."""
    if value is None or not math.isfinite(value):
        return ABSENT
    if value == 0 or not 1e-3 <= abs(value) < 1e5:
        return plain(value, 3)
    return fixed(value, max(0, 2 - math.floor(math.log10(abs(value)) + 1e-12)))


def said(p: Parameter) -> str:
    """Value with 95 % interval and unit, in words where the fit has none."""
    if (p.ci95[1] - p.ci95[0]) / 2 > WILD * max(abs(p.value), 1.0):
        return "not determined"
    if p.unit == "rad" and 0 < max(abs(p.value), (p.ci95[1] - p.ci95[0]) / 2) < FINE:
        return estimate(p.value / ARCSEC, (p.ci95[0] / ARCSEC, p.ci95[1] / ARCSEC), "arcsec")
    if p.unit in MILLI and 0 < max(abs(p.value), (p.ci95[1] - p.ci95[0]) / 2) < SMALL:
        return estimate(p.value * 1e3, (p.ci95[0] * 1e3, p.ci95[1] * 1e3), MILLI[p.unit])
    return estimate(p.value, p.ci95, p.unit)
