"""A form in the model, fitted with everything else, and what fitted runs make of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import WHOLE
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Solution, extended, fit
from rig.analysis.tracing.fit.some import Bounds, of_some
from rig.analysis.tracing.free_form.form import FreeForm
from rig.analysis.tracing.free_form.forms import forms
from rig.analysis.tracing.free_form.ranges import Ranges
from rig.analysis.tracing.prepared import Prepared
from rig.process.workers import each

RIDGE: Final = 1e-6  # of a column's square: some are sums of others, and of the baseline's
SURFACE: Final = 0.9  # of its evidence
KEPT: Final = 0.7  # of the sensors' noise in a channel, RMS, the least that a form leaves there
RANKED: Final = Bounds(15_000, 12_000, 400)  # rows that tell which of some dozen forms may be the best


@dataclass(frozen=True)
class Fitted:
    """The model with that form, and its evidence in nats, 0 where it foretells the sensors' noise      [hastie2009,
    Sec. 7.7]"""

    form: FreeForm
    solution: Solution
    evidence: float

    @property
    def worth(self) -> float:
        """Its evidence; of a surface, which draws whatever a curve does and some of the noise, a tenth less."""
        return self.evidence * (SURFACE if self.form.surface else 1.0)


def of_some_rows(p: Prepared, s: Solution, bounds: Bounds | None = None) -> Solution:
    """The model fitted to no more rows than a search: forms have hundreds of columns, and a day of rows has no room for
    them."""
    few, whole = of_some(s.design, p.split.fitted, bounds)
    return s if whole else fit(few)


def possible(p: Prepared, coordinate: str, finer: int = 1) -> list[FreeForm]:
    """Forms along that coordinate that what all fitted runs read can show."""
    runs = tuple(p.eq.runs[i] for i in p.split.fitted)
    has = frozenset.intersection(*(run.has for run in runs))
    return [form for form in forms(coordinate, Ranges(runs), finer) if form.wants <= has]


def likeliest(p: Prepared, s: Solution, made: Sequence[FreeForm], count: int) -> list[FreeForm]:
    """So many of the forms as few rows speak for most, the best first: of all rows all of them would take minutes."""
    few = of_some_rows(p, s, RANKED)
    worth = each(lambda form: fitted(p, few, form).worth, made)
    return [made[i] for i in sorted(range(len(made)), key=lambda i: -worth[i])[:count]]


def fitted(p: Prepared, s: Solution, form: FreeForm) -> Fitted:
    """With everything else."""
    d = extended(s.design, Term(form, ()), p.split.fitted)
    mine = np.arange(s.design.size, d.size)
    gram = d.gram.copy()
    gram[mine, mine] *= 1 + RIDGE
    made = fit(replace(d, gram=gram))
    if _takes_noise(s, made):
        return Fitted(form, made, 0.0)
    rows = sum(d.y[key].size / d.eq.noise.kappa[key[1]] for key in s.keys)
    return Fitted(form, made, (made.gain - s.gain) / 2 - mine.size / 2 * float(np.log(rows)))


def _takes_noise(before: Solution, after: Solution) -> bool:
    """Whether a channel has less of its sensors' noise with the form: no law foretells that, but a torque told by its
    own reading does, where little else in the campaign tells it."""
    return any(_noise(after, c) < KEPT * _noise(before, c) for c in WHOLE)


def _noise(s: Solution, channel: str) -> float:
    """What sensor noise leaves in a channel, RMS; 0 where no block of it is known for that."""
    left = [s.design.noise_left(key, s.x) for key in s.design.noise if key[1] == channel]
    return float(np.sqrt(np.mean(np.square(np.concatenate(left))))) if left else 0.0
