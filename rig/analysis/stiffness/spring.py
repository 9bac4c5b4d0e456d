"""The spring of one lock test: every law fitted, the one it supports, and K1, K2, K3 with their knots."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.stiffness.choice import LeftOut, Trial, attempt, leave_out, simplest
from rig.analysis.stiffness.curve import fit
from rig.analysis.stiffness.laws import Cubic, FreeLines, Law, Line, Lines, Play, Scale
from rig.analysis.stiffness.points import Points
from rig.analysis.stiffness.shape import Shape

MAKER = (54.0 / 255.0, 196.0 / 255.0)  # T1 and T2 over the limit for average torque, size 40, 1:50  [harmonicdrive]
INSIDE = (0.03, 0.97)  # of the tested torque: a fitted knot outside, or nearer to the other, is no knot
LEVELS = np.array([0.1, 0.5, 0.95])  # of the tested torque: where a law that bends is looked at


@dataclass(frozen=True)
class Spring:
    """The laws tried, simplest first, and what is shown of them."""

    trials: list[Trial]
    chosen: Trial
    chosen_out: LeftOut
    lines_out: LeftOut  # three lines, with given or fitted knots
    cubic_out: LeftOut
    knots: str  # where T1 and T2 come from, one sentence

    @property
    def fitted_knots(self) -> bool:
        """Whether T1 and T2 were fitted."""
        return self.lines_out.curve.law.name == FreeLines.name


def spring_of(points: Points, scale: Scale, shape: Shape, knots: tuple[float, float] | None) -> Spring:
    """`knots`: T1, T2 N·m where the bench declares them; else the maker's, scaled, unless the run shows its own."""
    given = knots if knots is not None and 0 < knots[0] < knots[1] < 0.95 * scale.torque else None
    T1, T2 = (given[0] / scale.torque, given[1] / scale.torque) if given else MAKER
    laws: tuple[Law, ...] = (Line(), Cubic(), Play(), Lines(T1, T2), FreeLines())
    line, cubic, _, lines, free = trials = [attempt(law, points, fit(law, points, scale, shape)) for law in laws]
    chosen = simplest(trials)
    if chosen is free and not _knots_inside(free):
        chosen = simplest(trials[:4])
    chosen_out = leave_out(chosen.curve, points)
    if chosen is not line and not chosen_out.bends(LEVELS * scale.torque):
        chosen, chosen_out = line, leave_out(line.curve, points)
    lines_out = chosen_out if chosen in (lines, free) else leave_out(lines.curve, points)
    cubic_out = chosen_out if chosen is cubic else leave_out(cubic.curve, points)
    said = f"Knots of the maker's table (54 and 196 N·m, size 40, 1:50), scaled: {scale.torque:.3g} for his 255 N·m."
    if given:
        said = "Knots as declared."
    if chosen is free:
        said = "Knots fitted."
    return Spring(trials, chosen, chosen_out, lines_out, cubic_out, said)


def _knots_inside(free: Trial) -> bool:
    n = free.curve.law.numbers(free.curve.p, free.curve.scale)
    T1, T2 = n["T1"] / free.curve.scale.torque, n["T2"] / free.curve.scale.torque
    low, high = INSIDE
    return low < T1 < T2 - low and high > T2
