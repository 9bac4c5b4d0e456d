"""What each effect does on runs the fit has not seen: the score by which it may be named or not."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rig.analysis.tracing.fit.channels import CHANNELS, WHOLE
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Design, Solution, without
from rig.analysis.tracing.floor.held_out import HeldOut
from rig.analysis.tracing.selection.as_repeats import as_repeats
from rig.analysis.tracing.selection.done import Noise, Without, done, noise_in, together
from rig.analysis.tracing.thresholds import (
    ABOUT,
    ALL,
    APART,
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
    STRETCHES,
    UNREAL,
    UNSTEADY,
    WHATEVER,
)
from rig.model.effect import Array


@dataclass(frozen=True)
class HeldOutScore:
    """One effect on held-out runs: share of the excess it removes where it acts, its RMS over the floor there, and the
    ratio that remains there. `true` is what it takes away over what it would if it were all real, `unsteady` how much
    the size that single runs want differs from the one all have (RMS, relative, beyond what noise makes), `apart` the
    same within the channel where it is worst. `harm` is by how much the worst channel is worse with it, `anywhere` the
    largest ratio that remains in a channel in which it acts at all, `overall` its RMS over the floor over all runs of
    the channel it does most in. `runs` fitted ones show it, or so many stretches of a lone one, between which its size
    differs by `stretched`. `as_repeats`: runs want sizes that differ by no more than those of repeats do. `seen` is its
    RMS over the floor in the fitted run that has most of it."""

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
    overall: float = 0.0
    runs: int = SEVERAL
    stretched: float = 0.0
    as_repeats: bool = False
    seen: float = 0.0

    @property
    def named(self) -> bool:
        """Whether it may be named."""
        loose = LOOSELY if self._explains_all else 1.0
        steady = self.unsteady < loose * UNSTEADY and self.apart < loose * APART
        one_size = (REAL < self.true < UNREAL and steady) or self.as_repeats
        real = self.size > SMALLEST and one_size and self.harm < HARMFUL
        # a law that leaves a loud rest may be another's: it must then at least take what it should, in one size
        loud = self.left > EXPLAINED and self.share < MOSTLY
        real = real and (self.fairly or not loud)
        return real and (self.share > NAMED or (self.left < QUIET and self.share > NAMED / 2))

    @property
    def fairly(self) -> bool:
        """Whether it takes away what it should, and wants one size in all runs, to a fifth or as well as repeats do."""
        return (abs(self.true - 1.0) < FAIRLY and max(self.unsteady, self.apart) < FAIRLY) or self.as_repeats

    @property
    def plain(self) -> bool:
        """Whether it is plainly what acts there, whatever its law leaves: most of the excess goes with it, with one
        size in all runs, of which there are a few: in one or two a size is the same for want of others. How large the
        rest is in floors says nothing against it: that of a law a little off grows with the effect."""
        one = max(self.unsteady, self.apart, self.stretched) < ABOUT and self.runs >= SEVERAL
        return self.share > PLAINLY and abs(self.true - 1.0) < ABOUT and one

    @property
    def whatever_the_floor(self) -> bool:
        """Whether it is so large, and so wholly what there is in every channel it acts in, that a floor no repeats tell
        may be twice what it is taken for: what is left stands in other channels."""
        return self.size > WHATEVER and self.all_there_is

    @property
    def is_foretold(self) -> bool:
        """Whether it is large on the held-out blocks, and of the size there, nearly all of it, that the fitted ones
        gave it: that it may be nothing is then said of a size that one run alone told, and wrong."""
        return self.size > WHATEVER and self.share > ALL and abs(self.true - 1.0) < FAIRLY

    @property
    def all_there_is(self) -> bool:
        """Whether it is large, of the size that it should be, and next to nothing is left in any channel it acts in:
        what may be left is another channel's, and it no part of that."""
        return self.size > WHATEVER / 2 and self._explains_all and self.anywhere < MISSING

    @property
    def _explains_all(self) -> bool:
        """Where next to nothing is left of it on unseen runs, sizes differ from run to run by less than the noise of a
        run's mean."""
        return self.share > ALL and self.left < MISSING and abs(self.true - 1.0) < FAIRLY


def scores(s: Solution, d: Design, at: HeldOut) -> list[HeldOutScore]:
    """Every effect in the model, scored by taking it away."""
    names = list(dict.fromkeys(t.name for t in d.terms))
    rests = [without(s, [i for i, t in enumerate(d.terms) if t.name == name]) for name in names]
    noise = noise_in(s, rests)
    seen, unseen = (_taken_away(s, rests, of, noise) for of in (s.design, d))
    whole = at.residuals(s, d)
    return [_score(*one, at, whole) for one in zip(names, seen, unseen, strict=True)]


def _score(name: str, seen: Without, unseen: Without, at: HeldOut, whole: Mapping[Key, Array]) -> HeldOutScore:
    """One effect: the others are fitted again without it."""
    d = unseen.design
    bare = at.residuals(unseen.rest, d, unseen.bare)
    places = {int(d.place(i).start) for i, t in enumerate(d.terms) if t.name == name}
    size: dict[Key, float] = {}
    for key in d.y:
        if any(int(part.at[0]) in places for part in d.parts[key]):
            f = bare[key] - whole[key]
            size[key] = float(np.sqrt(np.mean(f**2))) / at.floors[key]
    most = max(size.values(), default=0.0)
    if most == 0.0:  # it acts on no unseen run, or does nothing there
        return HeldOutScore(name, 0.0, 0.0, 1.0, 0.0, ())
    ground = tuple(key for key, r in size.items() if r >= 0.5 * most)
    before, n = at.excess(bare, ground)
    after, _ = at.excess(whole, ground)
    share = (before - after) / max(before - n, 0.02 * n)
    own = sum(size[key] ** 2 * whole[key].size for key in ground)
    true = float((before - after) / own)
    held, fitted = unsteadiness(unseen, at.floors), unsteadiness(seen, at.seen)
    unsteady, apart = max(held.whole, fitted.whole), max(held.apart, fitted.apart)
    alone = len({run for run, _ in seen.design.y}) < SEVERAL
    stretched, shown = _in_stretches(seen, at.seen) if alone else (0.0, fitted.shown)
    # at reversals stands what no effect that acts while the motor turns can be held to
    acts = [[k for k in size if k[1] == c] for c in CHANNELS if c != "R" or {"R"} == {k[1] for k in size}]
    return HeldOutScore(
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
        overall({key: r**2 * whole[key].size for key, r in size.items()}, d),
        shown,
        stretched,
        (at.calm or not at.loud(whole, MISSING)) and as_repeats(seen, unseen, at),
        fitted.most,
    )


def _taken_away(s: Solution, rests: Sequence[Solution], d: Design, noise: Sequence[Noise]) -> list[Without]:
    """Each effect in the blocks of a design, `rests` being the fits without one."""
    x = together(s, rests)
    made = {key: np.ascontiguousarray(d.residual(key, x).T) for key in d.y}
    left, *bare = ({key: e[i] for key, e in made.items()} for i in range(1 + len(rests)))
    return [Without(rest, d, left, e, own) for rest, e, own in zip(rests, bare, noise, strict=True)]


def overall(work: Mapping[Key, float], d: Design) -> float:
    """RMS over the floor, over all runs of a channel in the one where it is largest, of sums of squares by block. The
    motor torque of a locked output is left out where there is other: held against a full load, an effect shows there
    that hardly does in a gear that turns."""
    turning = [key for key in d.y if key[1] != "M" or not d.eq.runs[key[0]].locked]
    counted = turning if any(key in work for key in turning) else list(d.y)
    blocks = [[key for key in counted if key[1] == c] for c in CHANNELS]
    squares = [(sum(work.get(key, 0.0) for key in keys), sum(d.y[key].size for key in keys)) for keys in blocks if keys]
    return max(float(np.sqrt(max(square, 0.0) / rows)) for square, rows in squares)


def _in_stretches(seen: Without, floors: Mapping[Key, float]) -> tuple[float, int]:
    """How much the size differs from stretch to stretch of one or two fitted runs, and how many show it: in one long
    log they are what several runs would be. Of all channels together: what is left in another one wanders."""
    found = unsteadiness(seen, floors, STRETCHES)
    return found.whole, found.shown


def harm(at: HeldOut, bare: Mapping[Key, Array], whole: Mapping[Key, Array]) -> float:
    """Over the channels that are not quiet: largest RMS with the effect over that without it. What reversals have left
    says nothing: they are few rows, and what stands there beside a true effect is friction."""
    found = [1.0]
    for channel in WHOLE:
        keys = [key for key in whole if key[1] == channel]
        if keys and (now := at.ratio(whole, keys)) > EXPLAINED:
            found.append(now / max(at.ratio(bare, keys), 1e-9))
    return max(found)


class Unsteadiness(NamedTuple):
    """RMS, relative, weighted by what an effect does in a run, what noise makes of it taken off: over all channels, and
    in the worst of those it does a fair part of its work in. How many runs show it plainly, and its RMS over the floor
    in the one that has most of it."""

    whole: float
    apart: float
    shown: int
    most: float


def unsteadiness(one: Without, floors: Mapping[Key, float], parts: int = 1) -> Unsteadiness:
    """How much an effect's size differs from run to run; with `parts`, from stretch to stretch of each run.

    A block wants the size 1 + (f·e)/(f·f), f being what the effect does and e what is left with it. What only looks
    like an effect has its size from a compromise between runs; a real one has the same in each. Sensor noise is in
    both, and is taken off: one reading's noise in f and in e says nothing of a size.
    """
    spread, work = dict.fromkeys(CHANNELS, 0.0), dict.fromkeys(CHANNELS, 0.0)
    shown, most = set(), 0.0
    kappa = one.design.eq.noise.kappa
    for key, part, f, e in done(one, floors, parts):
        square, along = (e.size / floors[key] ** 2 * x for x in one.spoilt(key))
        own = float(f @ f) - square
        if own > FAINT**2 * e.size:
            chance = kappa[key[1]] * float(f @ f)
            spread[key[1]] += ((float(f @ e) - along) ** 2 - chance) / own
            work[key[1]] += own
        if own > SMALLEST**2 * e.size:
            shown.add((key[0], part))
            most = max(most, float(np.sqrt(own / e.size)))
    total = sum(work.values())
    fair = [c for c in CHANNELS if total and work[c] > FAIR * total]
    apart = max((np.sqrt(max(spread[c], 0.0) / work[c]) for c in fair), default=0.0)
    # a channel it hardly shows in says nothing of it: what is left there is something else's
    whole = np.sqrt(max(sum(spread[c] for c in fair), 0.0) / max(sum(work[c] for c in fair), 1e-300))
    return Unsteadiness(float(whole), float(apart), len(shown), most)
