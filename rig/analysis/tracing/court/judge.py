"""What each effect is worth on runs the fit has not seen, and which ones may be named."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rig.analysis.tracing.fit.channels import CHANNELS, WHOLE, known_of
from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.fit.model import Design, Solution, design, fit, without
from rig.analysis.tracing.fit.search import ROUNDS, as_fit, change, reduced
from rig.analysis.tracing.floor.noise import Measured
from rig.analysis.tracing.floor.of_a_run import floor_of, leniency
from rig.analysis.tracing.thresholds import (
    ABOUT,
    ALL,
    APART,
    ASTRAY,
    EXPLAINED,
    FAINT,
    FAIR,
    FAIRLY,
    HARMFUL,
    LOOSELY,
    MISSING,
    MOSTLY,
    NAMED,
    PLAINLY,
    QUIET,
    REAL,
    SEVERAL,
    SMALLEST,
    TURNED,
    UNREAL,
    UNSTEADY,
)
from rig.model.effect import Array, Parameter, Reach


@dataclass(frozen=True)
class Court:
    """Held-out blocks with their floors. Nothing here goes back into the fit."""

    runs: tuple[int, ...]
    floors: dict[Key, float]
    seen: dict[Key, float]  # floors of the fitted blocks
    lenient: dict[Key, float]  # how much more than others a single block may exceed its floor by chance

    def residuals(self, s: Solution, d: Design) -> dict[Key, Array]:
        """Of a solution on the held-out design `d`."""
        return {key: d.residual(key, s.x) for key in d.y}

    def excess(self, e: Mapping[Key, Array], keys: Sequence[Key]) -> tuple[float, int]:
        """Sum of squares over squared floors, and rows."""
        return (
            float(sum(e[k] @ e[k] / self.floors[k] ** 2 for k in keys)),
            sum(e[k].size for k in keys),
        )

    def ratio(self, e: Mapping[Key, Array], keys: Sequence[Key]) -> float:
        """RMS over floor of some blocks."""
        total, n = self.excess(e, keys)
        return float(np.sqrt(total / max(n, 1)))

    def loud(self, e: Mapping[Key, Array], single: float, named: bool = True) -> bool:
        """Whether a channel, or by more than `single` one run beside what chance does to it, has more left than may be.
        Reversals are few rows, whose floor no repeats tell: beside what is `named` they may have a little left."""
        turned = {key: x for key, x in e.items() if key[1] == "R"}
        if named and turned and self.worst(turned)[0] < TURNED:
            e = {key: x for key, x in e.items() if key[1] != "R"}
        most, one = self.worst(e)
        return most > EXPLAINED or one > single

    def worst(self, e: Mapping[Key, Array]) -> tuple[float, float]:
        """Largest RMS over floor of a channel, and of a single run in a channel beside what chance does to it."""
        by_channel = [[k for k in e if k[1] == c] for c in CHANNELS]
        return max(self.ratio(e, keys) for keys in by_channel if keys), max(
            self.ratio(e, [k]) / self.lenient[k] for k in e
        )


@dataclass(frozen=True)
class Worth:
    """One effect on held-out runs: share of the excess it removes where it acts, its RMS over the floor there, and the
    ratio that remains there. `true` is what it takes away over what it would if it were all real, `unsteady` how much
    the size that single runs want differs from the one all have (RMS, relative, beyond what noise makes), `apart` the
    same within the channel where it is worst. `harm` is by how much the worst channel is worse with it, `anywhere` the
    largest ratio that remains in a channel in which it acts at all, `work` its sum of squares over the floor's. `runs`
    fitted ones show it."""

    name: str
    share: float
    size: float
    left: float
    true: float
    ground: tuple[Key, ...]
    unsteady: float = 0.0
    apart: float = 0.0
    harm: float = 1.0
    anywhere: float = 0.0
    work: float = 0.0
    runs: int = SEVERAL

    @property
    def named(self) -> bool:
        """Whether it may be named."""
        real = self.size > SMALLEST and REAL < self.true < UNREAL and self.harm < HARMFUL
        loose = LOOSELY if self._explains_all else 1.0
        real = real and self.unsteady < loose * UNSTEADY and self.apart < loose * APART
        # a law that leaves a loud rest may be another's: it must then at least take what it should, in one size
        loud = self.left > EXPLAINED and self.share < MOSTLY
        real = real and (self.fairly or not loud)
        return real and (self.share > NAMED or (self.left < QUIET and self.share > NAMED / 2))

    @property
    def fairly(self) -> bool:
        """Whether it takes away what it should, and wants one size in all runs, to a fifth."""
        return abs(self.true - 1.0) < FAIRLY and max(self.unsteady, self.apart) < FAIRLY

    @property
    def plain(self) -> bool:
        """Whether it is plainly what acts there, whatever its law leaves: most of the excess goes with it, with one
        size in all runs, of which there are a few: in one or two a size is the same for want of others. How large the
        rest is in floors says nothing against it: that of a law a little off grows with the effect."""
        one = max(self.unsteady, self.apart) < ABOUT and self.runs >= SEVERAL
        return self.share > PLAINLY and abs(self.true - 1.0) < ABOUT and one

    @property
    def _explains_all(self) -> bool:
        """Where next to nothing is left of it on unseen runs, sizes differ from run to run by less than the noise of a
        run's mean."""
        return self.share > ALL and self.left < MISSING and abs(self.true - 1.0) < FAIRLY


def court(eq: Equations, measured: Measured, held_out: Sequence[int]) -> Court:
    """The held-out blocks, each with the floor of its condition."""
    floors = {key: floor_of(measured, eq, key) for key in eq.of(range(len(eq.runs)))}
    held = set(eq.of(held_out))
    seen = {key: floor for key, floor in floors.items() if key not in held}
    lenient = {key: leniency(measured, eq, key) for key in held}
    return Court(tuple(held_out), {key: floors[key] for key in eq.of(held_out)}, seen, lenient)


def unseen(s: Solution, at: Court) -> Design:
    """The model's columns on the held-out runs."""
    return design(replace(s.design.eq, noisy={}), s.design.terms, at.runs)


def worths(s: Solution, d: Design, at: Court) -> list[Worth]:
    """Every effect in the model, weighed by taking it away."""
    whole = at.residuals(s, d)
    return [worth(s, d, at, whole, name) for name in dict.fromkeys(t.name for t in d.terms)]


def worth(s: Solution, d: Design, at: Court, whole: Mapping[Key, Array], name: str) -> Worth:
    """One effect: the others are fitted again without it."""
    mine = [i for i, t in enumerate(d.terms) if t.name == name]
    rest = without(s, mine)
    bare = at.residuals(rest, d)
    places = {int(d.place(i).start) for i in mine}
    size: dict[Key, float] = {}
    for key in d.y:
        if any(int(part.at[0]) in places for part in d.parts[key]):
            f = bare[key] - whole[key]
            size[key] = float(np.sqrt(np.mean(f**2))) / at.floors[key]
    if not size:
        return Worth(name, 0.0, 0.0, 1.0, 0.0, ())
    most = max(size.values())
    ground = tuple(key for key, r in size.items() if r >= 0.5 * most)
    before, n = at.excess(bare, ground)
    after, _ = at.excess(whole, ground)
    share = (before - after) / max(before - n, 0.02 * n)
    own = sum(size[key] ** 2 * whole[key].size for key in ground)
    true = float((before - after) / own)
    held, seen = unsteadiness(s, rest, d, at.floors), unsteadiness(s, rest, s.design, at.seen)
    unsteady, apart = max(held[0], seen[0]), max(held[1], seen[1])
    # at reversals stands what no effect that acts while the motor turns can be held to
    acts = [[k for k in size if k[1] == c] for c in CHANNELS if c != "R" or {"R"} == {k[1] for k in size}]
    return Worth(
        name,
        float(share),
        most,
        float(np.sqrt(after / n)),
        true,
        ground,
        unsteady,
        apart,
        harm(at, bare, whole),
        max((at.ratio(whole, keys) for keys in acts if keys), default=0.0),
        sum(r**2 * whole[key].size for key, r in size.items()),
        seen[2],
    )


def harm(at: Court, bare: Mapping[Key, Array], whole: Mapping[Key, Array]) -> float:
    """Over the channels that are not quiet: largest RMS with the effect over that without it. What reversals have left
    says nothing: they are few rows, and what stands there beside a true effect is friction."""
    found = [1.0]
    for channel in WHOLE:
        keys = [key for key in whole if key[1] == channel]
        if keys and (now := at.ratio(whole, keys)) > EXPLAINED:
            found.append(now / max(at.ratio(bare, keys), 1e-9))
    return max(found)


def unsteadiness(s: Solution, rest: Solution, d: Design, floors: Mapping[Key, float]) -> tuple[float, float, int]:
    """How much an effect's size differs from run to run: RMS, relative, weighted by what it does there, what noise
    makes of it taken off; over all channels, and in the worst of those it does a fair part of its work in. And how many
    runs show it plainly. `rest` is the fit without the effect.

    A block wants the size 1 + (f·e)/(f·f), f being what the effect does and e what is left with it. What only looks
    like an effect has its size from a compromise between runs; a real one has the same in each.
    """
    spread, work = dict.fromkeys(CHANNELS, 0.0), dict.fromkeys(CHANNELS, 0.0)
    shown = set()
    for key in d.y:
        e = d.residual(key, s.x) / floors[key]
        f = d.residual(key, rest.x) / floors[key] - e
        own = float(f @ f)
        if own > FAINT**2 * e.size:
            spread[key[1]] += float(f @ e) ** 2 / own - d.eq.noise.kappa[key[1]]
            work[key[1]] += own
        if own > SMALLEST**2 * e.size:
            shown.add(key[0])
    total = sum(work.values())
    fair = [c for c in CHANNELS if total and work[c] > FAIR * total]
    apart = max((np.sqrt(max(spread[c], 0.0) / work[c]) for c in fair), default=0.0)
    # a channel it hardly shows in says nothing of it: what is left there is something else's
    whole = np.sqrt(max(sum(spread[c] for c in fair), 0.0) / max(sum(work[c] for c in fair), 1e-300))
    return float(whole), float(apart), len(shown)


def convicted(s: Solution, at: Court) -> tuple[Solution, Design, list[Worth]]:
    """The model with the effects alone that may be named; the least worth goes first, then all are weighed again."""
    d = unseen(s, at)
    while True:
        weighed = worths(s, d, at)
        failing = [w for w in weighed if not w.named or not _can_be(s, w.name)]
        if not failing:
            return s, d, weighed
        # what spoils a channel spoils the others' sizes with it
        worst = min(failing, key=lambda w: (-max(w.harm, HARMFUL), min(w.share, 1.0) * w.size))
        gone = [i for i, t in enumerate(d.terms) if t.name == worst.name]
        s, d = fit(reduced(s.design, gone)), reduced(d, gone)
        if (again := _put_right(s)) is not s:
            s, d = again, unseen(again, at)


def _put_right(s: Solution) -> Solution:
    """With columns that lean on what the fit says now, where a refused effect had led them astray: beside a spring half
    as stiff as it is even a true effect has the wrong size."""
    for _ in range(ROUNDS):
        eq = s.design.eq
        before = eq.runs[0].pieces[0].gear
        now = known_of(s.values, before)
        if change(before, now) < ASTRAY:
            break
        s = fit(design(eq.knowing(now), s.design.terms, sorted({run for run, _ in s.design.y})))
    return s


def _can_be(s: Solution, name: str) -> bool:
    """Whether the terms of an effect have the signs and sizes such an effect can have, now that all are fitted; where
    they make one sum, whether that has."""
    d = s.design
    fits = [(t, as_fit(s, t, s.x[d.place(i)])) for i, t in enumerate(d.terms) if t.name == name]
    sums = [p.value for t, f in fits for p in t.effect.parameters(f) if p.name in t.effect.adds]
    return sum(sums) > 0 if len(fits) > 1 and sums else all(t.effect.plausible(f) for t, f in fits)


def unresolved(s: Solution, words: Mapping[str, Sequence[Parameter]], covered: Reach) -> list[str]:
    """Effects of whose law the data say nothing, in any term: the interval of the number that scales it (a Stribeck
    speed, a torque, a time) contains zero, or it is a resonance beyond all that was excited. What is left of them is a
    difference between some runs and others, which many laws make.
    """
    names = dict.fromkeys(term.name for term in s.design.terms)
    zero = [name for name in names if (found := scales(s, name, words)) and not _is_scaled(s, name, found, covered)]
    return [*zero, *(name for name in names if name not in zero and _out_of_reach(s, name, covered))]


def scales(s: Solution, name: str, words: Mapping[str, Sequence[Parameter]]) -> list[Parameter]:
    """The first shape parameter that is fitted, of every term of an effect: the second one's is numbered."""
    effect = next(term.effect for term in s.design.terms if term.name == name)
    first = [n for n, free in zip(effect.shape_names, effect.loose, strict=True) if free][:1]
    return [p for p in words.get(name, ()) for n in first if p.name == n or p.name.removeprefix(f"{n}_").isdigit()]


def _is_scaled(s: Solution, name: str, found: Sequence[Parameter], covered: Reach) -> bool:
    effect = next(term.effect for term in s.design.terms if term.name == name)
    return any(effect.is_scaled(p, covered) for p in found)


def _out_of_reach(s: Solution, name: str, covered: Reach) -> bool:
    terms = [term for term in s.design.terms if term.name == name]
    return all(term.effect.beyond(term.shape, covered) for term in terms)
