"""A load sweep in lines: peak to peak by load, up and down, and the law through them."""

from __future__ import annotations

from collections.abc import Sequence

from rig.analysis.across_runs.load_law import LoadRun, down_less_up, load_law
from rig.analysis.findings.intervals import Ranged
from rig.report.numbers import estimate


def told(runs: Sequence[LoadRun]) -> list[str]:
    """Lines for people."""
    lines = ["peak to peak of the kinematic error by load, arcsec", "     N·m      up    down"]
    for load in sorted({r.load for r in runs}, key=abs):
        ways = [[r.peak_to_peak for r in runs if r.load == load and r.down is down] for down in (False, True)]
        shown = "".join(f"{sum(way) / len(way):8.2f}" if way else "       –" for way in ways)
        lines.append(f"{load:8g}{shown}")
    law, apart = load_law(runs), down_less_up(runs)
    if apart is not None:
        lines.append(f"down less up {_shown(apart, 'arcsec')}, mean over the loads that were run both ways")
    if law is None:
        return [*lines, "no law fitted: it takes five runs at four loads or more"]
    if not law.falls:
        return [*lines, f"load makes no difference that is told from none; the runs scatter by {law.rms:.2g} arcsec"]
    return [
        *lines,
        f"P(T) = P_∞ + (P_0 − P_∞)·exp(−|T|/T_c), rms left {law.rms:.2g} arcsec, 95 % intervals:",
        f"  P_0 {_shown(law.P_0, 'arcsec')}, P_∞ {_shown(law.P_inf, 'arcsec')}, T_c {_shown(law.T_c, 'N·m')}",
    ]


def _shown(found: Ranged, unit: str) -> str:
    return estimate(found.value, (found.low, found.high), unit)
