"""Which effects together explain what the baseline leaves: forward, with drops, on the fitted runs alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from rig.analysis.tracing.fit.bank import Bank
from rig.analysis.tracing.fit.channels import CHANNELS
from rig.analysis.tracing.fit.equations import Key, Term
from rig.analysis.tracing.fit.leaning import leaning
from rig.analysis.tracing.fit.model import Design, Solution, design, extended, fit, without
from rig.analysis.tracing.fit.own_reading import leaves_most
from rig.analysis.tracing.fit.refine import refine
from rig.analysis.tracing.fit.scan import Drop, Own, drops, own
from rig.analysis.tracing.thresholds import CLOSEST, EVIDENCE, MOST, NEARLY, RELATIVE, SMALLEST, STILL, STILL_RUN
from rig.model.effect import Array, Fit, Reach
from rig.process.workers import each

ROUNDS = 4
RUNS_AWAY = 1.5  # times what was left before: columns that lean on a little too much are off by less
SETTLED = 2e-3  # relative: then columns made with the old values are off by a fiftieth of the floor at 30 times it
ROUGHLY = 1e-2  # relative: enough to tell which term comes next


@dataclass(frozen=True)
class Scored:
    """A term of the bank with its evidence in nats."""

    term: Term
    evidence: float
    drop: float
    size: float  # RMS over floor where it matters most
    laws: tuple[Term, ...] = ()  # others of the same effect with nearly as much


@dataclass(frozen=True)
class Found:
    """Terms in the model and the fit; `ranking` is the first round's, best shape of each effect. `rough`: shapes were
    found on some of the rows."""

    solution: Solution
    ranking: tuple[Scored, ...]
    rough: bool = False

    @property
    def names(self) -> tuple[str, ...]:
        """Effects in the model, once each, in order of entry."""
        return tuple(dict.fromkeys(term.name for term in self.solution.design.terms))


@dataclass(frozen=True)
class Search:
    """What stays the same during a search."""

    bank: Bank
    own: Own
    runs: tuple[int, ...]
    keys: tuple[Key, ...]
    covered: Reach
    excluded: frozenset[str]

    def ranked(self, s: Solution, u: dict[str, Array]) -> list[Scored]:
        """All terms by evidence, best first; excluded ones and those with an impossible sign are left out."""
        n = sum(s.design.y[key].size / s.design.eq.noise.kappa[key[1]] for key in self.keys)
        tried: dict[str, int] = {}
        for term in self.bank.terms:
            tried[term.name] = tried.get(term.name, 0) + 1
        out = []
        for found in drops(self.bank, self.own, u, s):
            term = self.bank.terms[found.term]
            k = found.coefficients.size
            evidence = found.drop / 2 - k / 2 * np.log(n) - np.log(tried[term.name])
            out.append((evidence, found, term))
        out.sort(key=lambda item: -item[0])
        out = [item for item in out if item[2].name not in self.excluded]
        likely = [(e, f, term) for e, f, term in out if e > 0 and possible(s, term, f.coefficients)]
        return [Scored(term, float(e), f.drop, self.size(s.design, f)) for e, f, term in likely[:60]]

    def least(self, r: Scored, ranking: Sequence[Scored]) -> float:
        """Evidence that `r` must have: more than what the law of the first of `ranking` has wrong, where both act."""
        first = ranking[0]
        shadow = not self.acts[r.term.name].isdisjoint(self.acts.get(first.term.name, ()))
        return max(EVIDENCE, RELATIVE * first.evidence) if shadow else EVIDENCE

    @cached_property
    def acts(self) -> dict[str, set[str]]:
        """Channels in which any law of an effect shows, by its name."""
        found: dict[str, set[str]] = {}
        for i, term in enumerate(self.bank.terms):
            found.setdefault(term.name, set()).update(c for c, at in self.bank.places.items() if at[i] is not None)
        return found

    def size(self, d: Design, found: Drop) -> float:
        """RMS of the term over the floor, in the block where it is largest."""
        most = 0.0
        for key in self.keys:
            place = self.bank.places[key[1]][found.term]
            if place is not None and key in self.bank.columns:
                f = self.bank.columns[key][:, place] @ found.coefficients.astype(np.float32)
                most = max(most, float(np.sqrt(f @ f / f.size)) / d.eq.noise.sigma[key[1]])
        return most


def search(
    d: Design,
    bank: Bank,
    runs: Sequence[int],
    keys: Sequence[Key],
    covered: Reach,
    floors: Mapping[Key, float],
    ranking: tuple[Scored, ...] = (),
    excluded: frozenset[str] = frozenset(),
    quiet: bool = False,
) -> Found:
    """Add the best term again and again, then drop what the later ones made needless. `ranking` is that of the first
    round when this is no first search; effects `excluded` are not tried; `quiet`: one term is tried even if nothing is
    above the floor."""
    s = fit(d)
    fixed = Search(bank, own(bank, d), tuple(runs), tuple(keys), covered, excluded)
    carried = _carries(d)
    barren: set[Term] = set()  # found needless as soon as the others were fitted again
    for _ in range(MOST - len(d.terms)):
        if still(s, floors) and not (quiet and not s.design.terms):
            break
        ranked = fixed.ranked(s, bank.crossed.of(d, keys))
        ranking = ranking or _best_of_each(ranked, NEARLY)
        worth = [
            r for r in ranked if r.evidence > fixed.least(r, ranking) and r.size > SMALLEST and r.term not in barren
        ]
        worth = [r for r in worth if _new(r.term, s)]
        if not worth:
            break
        chosen, refined = _best_refined(s.design, worth, runs, covered)
        s = settled(refined, runs, covered, ROUGHLY)
        entered = s.design.terms[-1]
        s, greedy = _without_greedy(_pruned(s), runs)
        d = s.design
        barren |= greedy
        if entered not in d.terms:
            barren.add(chosen.term)
        if _carries(d) and not carried:
            break  # columns of the bank go by a torque without that weight: they are made anew
    return Found(settled(s, runs, covered) if s.design.terms else s, ranking)


def _carries(d: Design) -> bool:
    """Whether the torque of a load that nobody read has what effects in it take."""
    return any(run.carries for run in d.eq.runs)


def ranking_beside(
    d: Design, bank: Bank, runs: Sequence[int], keys: Sequence[Key], covered: Reach, nearly: float
) -> tuple[Scored, ...]:
    """The best shape of every effect, by what it explains beside what the design has, and its laws that explain
    `nearly` as much, a share of it."""
    fixed = Search(bank, own(bank, d), tuple(runs), tuple(keys), covered, frozenset())
    return _best_of_each(fixed.ranked(fit(d), bank.crossed.of(d, keys)), nearly)


def _best_refined(d: Design, worth: Sequence[Scored], runs: Sequence[int], covered: Reach) -> tuple[Scored, Solution]:
    """The best of `worth` once its shape is refined, and the fit: among the first, those of other effects or laws with
    nearly as much evidence. Shapes in the bank are a step apart, and by half a step a look-alike can be ahead, in all
    of its laws."""
    close: dict[tuple[str | float, ...], Scored] = {}
    for r in worth:
        if r.evidence > NEARLY * worth[0].evidence:
            close.setdefault((r.term.name, *_chosen(r.term)), r)
    first = _of_every_effect(list(close.values()))[:CLOSEST]

    def refined(r: Scored) -> tuple[float, Term]:
        s = refine(d, r.term, runs, covered)[1]
        return _worth(s), s.design.terms[-1]

    if len(first) == 1:  # by itself it need not be fitted twice
        return first[0], refine(d, first[0].term, runs, covered)[1]
    made = each(refined, first)
    best = max(range(len(first)), key=lambda i: made[i][0])
    return first[best], fit(extended(d, made[best][1], runs))


def _of_every_effect(close: Sequence[Scored]) -> list[Scored]:
    """The first law of every effect before the others."""
    names = [r.term.name for r in close]
    return [close[i] for i in sorted(range(len(close)), key=lambda i: names[i] in names[:i])]


def _worth(s: Solution) -> float:
    """What a fit explains less what so many coefficients and shapes do by chance: laws of one effect differ in them."""
    return s.gain - EVIDENCE * (s.x.size + sum(len(term.shape) for term in s.design.terms))


def possible(s: Solution, term: Term, coefficients: Array) -> bool:
    """Whether signs and sizes are such an effect's."""
    if not term.effect.plausible(as_fit(s, term, coefficients)):
        return False
    return leaves_most(s.design.eq, sorted({run for run, _ in s.design.y}), term, coefficients)


def as_fit(s: Solution, term: Term, coefficients: Array) -> Fit:
    """The coefficients of one term, without their covariance."""
    size = coefficients.size + len(term.shape)
    first = s.design.eq.runs[0]
    return Fit(coefficients, term.shape, np.zeros((size, size)), first.gear, first.ratio)


def still(s: Solution, floors: Mapping[Key, float]) -> bool:
    """Whether nothing is left in any channel, nor in any single run."""
    square = {key: float(np.mean(s.residual(key) ** 2)) / floors[key] ** 2 for key in s.keys}
    rows = {key: s.design.y[key].size for key in s.keys}
    for channel in CHANNELS:
        mine = [key for key in s.keys if key[1] == channel]
        if mine and np.average([square[k] for k in mine], weights=[rows[k] for k in mine]) > STILL**2:
            return False
    return max(square.values()) < STILL_RUN**2


def settled(s: Solution, runs: Sequence[int], covered: Reach, enough: float = SETTLED) -> Solution:
    """Refitted until what the columns lean on (θ̃_p, inertias) is what the fit says, to `enough`, or until it runs away
    from it: without a load angle an inertia that comes out too large can make one that is larger still."""
    for _ in range(ROUNDS):
        d = s.design
        eq = leaning(d.eq, s, enough)
        if eq is d.eq:
            break
        terms = d.terms
        d = replace(reduced(d, range(len(terms))), eq=eq) if eq.rows is d.eq.rows else design(eq, (), runs)
        for term in terms[:-1]:
            d = extended(d, term, runs)
        again = refine(d, terms[-1], runs, covered)[1]
        if _left(again) > RUNS_AWAY * _left(s):
            break
        s = again
    return s


def _left(s: Solution) -> float:
    """Weighted sum of squares of what a fit leaves."""
    return sum(s.design.eq.noise.weight(key[1]) * float(np.sum(s.residual(key) ** 2)) for key in s.keys)


def polished(s: Solution, runs: Sequence[int], covered: Reach) -> Solution:
    """Every term's shape found again beside the terms that are left, each in its turn."""
    for term in s.design.terms:
        i = s.design.terms.index(term)
        s = refine(reduced(s.design, [i]), term, runs, covered)[1]
    return settled(s, runs, covered) if s.design.terms else s


def relawed(s: Solution, runs: Sequence[int], covered: Reach) -> Solution:
    """Every effect that remembers, tried in its other laws too: which law it is shows only beside free offsets."""
    for term in [t for t in s.design.terms if t.effect.remembers]:
        bare = reduced(s.design, [i for i, t in enumerate(s.design.terms) if t.name == term.name])
        fixed = {_chosen(t) for t in s.design.terms if t.name == term.name}
        others = [Term(term.effect, shape) for shape in term.effect.shapes(covered)]
        others = [other for other in others if _chosen(other) not in fixed]
        if others:
            best = max(others, key=lambda other: _worth(fit(extended(bare, other, runs))))
            other = refine(bare, best, runs, covered)[1]
            s = other if _worth(other) > _worth(s) else s
    return s


def _chosen(term: Term) -> tuple[float, ...]:
    """The part of the shape that a refit does not move."""
    return tuple(v for v, loose in zip(term.shape, term.effect.loose, strict=True) if not loose)


def _new(term: Term, s: Solution) -> bool:
    mine = [t for t in s.design.terms if t.name == term.name]
    return not any(t.effect.holds(t.shape) or _same(t, term) for t in mine)


def _same(a: Term, b: Term) -> bool:
    """The same effect again in a shape that the refit would have found."""
    fixed = [i for i, loose in enumerate(a.effect.loose) if not loose]
    expand = a.effect.expands(a.shape) and a.effect.expands(b.shape)
    if np.isfinite(a.effect.modes_apart):
        first = a.effect.loose.index(True)
        if abs(np.log(a.shape[first] / b.shape[first])) > np.log(a.effect.modes_apart):
            return False
    return expand or all(abs(a.shape[i] - b.shape[i]) < 1e-9 for i in fixed)


def _best_of_each(ranked: Sequence[Scored], nearly: float) -> tuple[Scored, ...]:
    """The best shape of each effect, with those of its other laws that have `nearly` as much evidence."""
    best: dict[str, list[Scored]] = {}
    for r in ranked:
        mine = best.setdefault(r.term.name, [])
        near = not mine or r.evidence > nearly * mine[0].evidence
        if near and len(mine) < CLOSEST and all(_chosen(r.term) != _chosen(other.term) for other in mine):
            mine.append(r)
    return tuple(replace(first, laws=tuple(r.term for r in others)) for first, *others in best.values())


def _pruned(s: Solution) -> Solution:
    """Without terms that explain nothing any more beside the newer ones."""
    d = s.design
    while len(d.terms) > 1:
        n = sum(d.y[key].size / d.eq.noise.kappa[key[1]] for key in s.keys)
        loss = [(s.gain - without(s, [i]).gain) / 2 - d.widths[i] / 2 * np.log(n) for i in range(len(d.terms))]
        worst = int(np.argmin(loss))
        if loss[worst] > EVIDENCE:
            break
        d = reduced(d, [worst])
        s = fit(d)
    return s


def _without_greedy(s: Solution, runs: Sequence[int]) -> tuple[Solution, set[Term]]:
    """Without laws of a torque's own reading that take most of it by now, and those: beside one that came in with less
    a true effect may have been pruned as needless (a Stribeck fall, its friction told by a torque constant of nothing).
    """
    d = s.design
    gone = [i for i, t in enumerate(d.terms) if not leaves_most(d.eq, runs, t, s.x[d.place(i)])]
    return (fit(reduced(d, gone)), {d.terms[i] for i in gone}) if gone else (s, set())


def reduced(d: Design, gone: Sequence[int]) -> Design:
    """The design without some of its terms."""
    lost = np.concatenate([np.arange(d.size)[d.place(i)] for i in gone]) if gone else np.zeros(0, int)
    stay = np.setdiff1d(np.arange(d.size), lost)
    new = np.full(d.size, -1)
    new[stay] = np.arange(stay.size)
    parts = {
        key: tuple(replace(part, at=new[part.at]) for part in parts if new[part.at[0]] >= 0)
        for key, parts in d.parts.items()
    }
    left = [i for i in range(len(d.terms)) if i not in set(gone)]
    return replace(
        d,
        terms=tuple(d.terms[i] for i in left),
        widths=tuple(d.widths[i] for i in left),
        parts=parts,
        gram=d.gram[np.ix_(stay, stay)],
        right=d.right[stay],
    )
