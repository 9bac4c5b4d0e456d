"""The curves the figures of a lock test are drawn from."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.collected import Findings
from rig.analysis.stiffness.measure import Stiffness
from rig.core.units import ARCMIN

MOST = 4000  # points drawn
WINDOW = 0.12  # of the reach, either side: over which the measured local stiffness is a slope
STEPS = 41


def add_curves(found: Findings, s: Stiffness) -> None:
    """Torque against wind-up with the fitted lines (the paper's Fig. 13), and local stiffness against torque."""
    run, lines, chosen = s.run, s.spring.lines_out.curve, s.spring.chosen.curve
    step = max(run.tau.size // MOST, 1)
    w = run.windup[::step]
    numbers = lines.law.numbers(lines.p, lines.scale)
    ends = np.array([run.points.tau.min(), run.points.tau.max()])
    inner = [x for x in (-numbers["T2"], -numbers["T1"], numbers["T1"], numbers["T2"]) if ends[0] < x < ends[1]]
    knots = np.array([ends[0], *inner, ends[1]])
    at = lines.law.windup(knots, lines.p, lines.scale)
    found.curve(
        lock__windup=(w - lines.middle) / ARCMIN,
        lock__torque=run.tau[::step],
        lock__departure=run.tau[::step] - lines.torque(w),
        lock__fit_windup=at / ARCMIN,
        lock__fit_torque=knots,
    )
    torque = np.linspace(ends[0], ends[1], 161)
    u = chosen.law.windup(torque, chosen.p, chosen.scale)
    found.curve(tangent__torque=torque, tangent__fit=chosen.tangent(chosen.middle + u))
    _add_measured_slopes(found, s)


def _add_measured_slopes(found: Findings, s: Stiffness) -> None:
    """Slopes of the points, their loop taken off, over a sliding window: no law in it."""
    points, curve = s.run.open, s.spring.chosen.curve
    level = points.tau - (curve.predicted(points) - curve.torque(points.windup))
    u, reach = points.windup - curve.middle, points.reach
    torque, slope = [], []
    for centre in np.linspace(-0.86, 0.86, STEPS) * reach:
        here = np.abs(u - centre) <= WINDOW * reach
        x = u[here] - u[here].mean()
        if here.sum() >= 8 and float(x @ x) > 0:
            torque.append(float(level[here].mean()))
            slope.append(float(x @ level[here]) / float(x @ x))
    if len(torque) > 2:
        found.curve(tangent__measured_torque=np.array(torque), tangent__measured=np.array(slope))
