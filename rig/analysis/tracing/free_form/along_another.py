"""Whether what seems to live along one coordinate is a law along another, as it is at the port where it acts.

Bins of one channel see the product of two things, a gain that falls with the speed under several weights, best along
whatever tells those runs apart: the time they were taken at, what the torque has been. And what wears off after a
reversal is at the same angle in every run that turns back there. A form at the right port needs the one coordinate
alone, and has more evidence.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.free_form.along import BY_THE_CLOCK, BY_THE_OUTPUT
from rig.analysis.tracing.free_form.fitted import Fitted, fitted, likeliest, of_some_rows, possible
from rig.analysis.tracing.free_form.form import FreeForm
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.joined import loudness
from rig.analysis.tracing.thresholds import EVIDENCE, FAR_LESS, PLAIN_ENOUGH
from rig.process.workers import each

PLAIN: Final = ("motor_angle", "load_angle", "speed", "load", "direction")
SHARP: Final = 4  # times as fine as usual: a dent in a race is two degrees wide
LIKELY: Final = 3  # forms along a coordinate that few rows speak for most
ANYTHING: Final = ("time", "temperature", "memory")  # of many numbers, along which runs differ anyhow


def along_another(p: Prepared, s: Solution, said: Home) -> Home | None:
    """Another coordinate along which fitted runs want a form by far more than any along what is `said`, a plain one in
    the place of time or memory by more; None where there is none, or a step at one moment or the clock is said. Where
    the difference is less, what two of them share is now and then drawn better along the wrong one; and an order that
    no form has is not outdone by one that takes less of what is left. Nor is a memory outdone by the campaign's clock:
    whatever a memory makes of single runs, a curve through the times they were taken at draws."""
    if said.first or said.coordinate not in (*PLAIN, *ANYTHING):
        return None
    s = of_some_rows(p, s)
    best = _best_along_each(p, s)
    _, mine = best.get(said.coordinate, (None, 0.0))

    def simpler(name: str) -> bool:
        return name in PLAIN and said.coordinate in ANYTHING

    def far_less(theirs: float, name: str) -> bool:
        return theirs > EVIDENCE and mine < (PLAIN_ENOUGH if simpler(name) else FAR_LESS) * theirs

    def dates_runs(form: FreeForm) -> bool:
        return said.coordinate == "memory" and form.words.endswith(BY_THE_CLOCK)

    found = {name: theirs for name, (form, theirs) in best.items() if not dates_runs(form)}
    better = {name: theirs for name, theirs in found.items() if far_less(theirs, name)}
    if not better:
        return None
    name = max(better, key=lambda n: better[n] * (1.0 if n in PLAIN else PLAIN_ENOUGH))
    takes = _share(p, s, fitted(p, s, best[name][0]), said.channel)
    enough = takes >= (PLAIN_ENOUGH if simpler(name) else 1.0) * min(said.share, 1.0)
    return Home(name, said.channel, takes) if enough else None


def _best_along_each(p: Prepared, s: Solution) -> dict[str, tuple[FreeForm, float]]:
    """Of the curves along each coordinate that few rows speak for most the one that all rows do, and how much."""
    along = {form: name for name in (*PLAIN, *ANYTHING) for form in possible(p, name) if not form.surface}
    along |= {form: "load_angle" for form in possible(p, "load_angle", SHARP) if form.words.endswith(BY_THE_OUTPUT)}
    ranked = likeliest(p, s, list(along), len(along))
    first = [form for name in (*PLAIN, *ANYTHING) for form in [f for f in ranked if along[f] == name][:LIKELY]]
    evidence = each(lambda form: fitted(p, s, form).evidence, first)
    made = sorted(zip(first, evidence, strict=True), key=lambda one: one[1])
    return {along[form]: (form, theirs) for form, theirs in made}  # the last of each is the best


def _share(p: Prepared, s: Solution, one: Fitted, channel: str) -> float:
    """Of the excess of a channel of fitted runs, what the form takes."""
    left = ({key: made.residual(key) for key in made.keys} for made in (s, one.solution))
    before, after = (loudness(e, p.floors)[channel] - 1.0 for e in left)
    return float(np.clip(1.0 - after / max(before, 1e-9), 0.0, 1.0))
