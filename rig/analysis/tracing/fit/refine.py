"""The exact shape of a term: Gauss-Newton on the columns themselves, one effect at a time, everything else free."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Design, Solution, extended, fit
from rig.analysis.tracing.thresholds import EVIDENCE, OTHER_LAW
from rig.model.effect import Array, Reach, Shape

NUDGE = 1e-2  # relative, of a shape parameter: large against rounding, small against a shape's width
LARGEST = 0.7  # of the logarithm, in one step: no further than the neighbour in the bank
CLOSE = 2e-3  # relative: further steps change no figure that is shown
ROUNDS = 4


def refine(d: Design, term: Term, runs: Sequence[int], covered: Reach) -> tuple[Design, Solution]:
    """The design with `term` in the shape that fits best, and its solution. A law is a textbook's, and its
    exponent, unless the runs tell another one plainly: torques nobody measured move the motor a little, and bend what
    friction seems to do with its speed."""
    free = [i for i, loose in enumerate(term.effect.loose) if loose]
    names, usual = term.effect.shape_names, term.effect.usual
    if any(other.name == term.name for other in d.terms):
        # beside another term of the effect an exponent means little, and two of them run away from each other
        return in_its_law(d, term, runs, covered)
    best = _refined(d, term, runs, covered, free)
    if not usual:
        return best
    shape = best[0].terms[-1].shape
    laws = [dict(zip(usual, law, strict=True)) for law in itertools.product(*usual.values())]
    begun = [tuple(law.get(name, v) for name, v in zip(names, shape, strict=True)) for law in laws]
    made = [in_its_law(d, replace(term, shape=x), runs, covered) for x in begun]
    plain = max(made, key=lambda one: one[1].gain)
    rows = sum(y.size / d.eq.noise.kappa[channel] for (_, channel), y in d.y.items())
    least = max(2 * EVIDENCE, OTHER_LAW * min(plain[1].gain - fit(d).gain, rows))
    return plain if best[1].gain - plain[1].gain < least else best


def in_its_law(d: Design, term: Term, runs: Sequence[int], covered: Reach) -> tuple[Design, Solution]:
    """The same in the law that the term has, whatever the runs tell of others."""
    names, usual = term.effect.shape_names, term.effect.usual
    return _refined(d, term, runs, covered, [i for i, x in enumerate(term.effect.loose) if x and names[i] not in usual])


def _refined(
    d: Design, term: Term, runs: Sequence[int], covered: Reach, free: Sequence[int]
) -> tuple[Design, Solution]:
    best = extended(d, term, runs)
    found = fit(best)
    if term.effect.expands(term.shape):
        best, found = _expanded(d, best, found, runs)
    if not free:
        return best, found
    gain, bounds = found.gain, term.effect.bounds(covered)
    for _ in range(ROUNDS):
        step = shape_step(best, found, runs, free)
        moved = False
        for share in (1.0, 0.3):
            shape = _moved(best.terms[-1].shape, share * np.clip(step, -LARGEST, LARGEST), free, bounds)
            trial = extended(d, replace(best.terms[-1], shape=shape), runs)
            tried = fit(trial)
            if tried.gain > gain:
                best, found, gain, moved = trial, tried, tried.gain, True
                break
        if not moved or np.max(np.abs(step)) < CLOSE:
            break
    return _expanded(d, best, found, runs) if term.effect.expands(term.shape) else (best, found)


def shape_step(best: Design, found: Solution, runs: Sequence[int], free: Sequence[int]) -> Array:
    """Change of the logarithm of each free shape parameter of the last term that lowers the error most."""
    term, c = best.terms[-1], found.x[best.place(len(best.terms) - 1)]
    wide = best
    for i in free:
        wide = extended(wide, nudged(term, i, c), runs, held=False)  # a shape held still would not be found
    x = fit(wide).x
    return np.asarray(x[best.size :])


def nudged(term: Term, i: int, c: Array, noise_kept: bool = False) -> Term:
    """One column: how the term with coefficients `c` changes with the logarithm of shape parameter `i`; with the noise
    in it taken off, as of all columns, or `noise_kept`."""
    from rig.analysis.tracing.fit.slope import Slope

    return Term(Slope(term.effect, i, NUDGE, tuple(map(float, c)), noise_kept), term.shape)


def _moved(shape: Shape, step: Array, free: Sequence[int], bounds: Sequence[tuple[float, float]]) -> Shape:
    out = list(shape)
    for i, by in zip(free, step, strict=True):
        out[i] = float(np.clip(out[i] * np.exp(by), *bounds[i]))
    return tuple(out)


def _expanded(d: Design, best: Design, found: Solution, runs: Sequence[int]) -> tuple[Design, Solution]:
    """An effect whose columns are an expansion about its own coefficient: take that as the next point."""
    for _ in range(3):
        term = best.terms[-1]
        shape = term.effect.about(term.shape, found.x[best.place(len(best.terms) - 1)])
        best = extended(d, replace(term, shape=shape), runs)
        found = fit(best)
    return best, found
