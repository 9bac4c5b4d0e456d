"""The held-out runs: what a model leaves there, beside the floor of each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.special import chdtri

from rig.analysis.tracing.fit.channels import CHANNELS, INDEX
from rig.analysis.tracing.fit.covariance import scatter
from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.fit.model import Design, Solution, design
from rig.analysis.tracing.floor.friction import Scattering
from rig.analysis.tracing.floor.local import at_rows
from rig.analysis.tracing.floor.noise import Measured
from rig.analysis.tracing.floor.of_a_run import floor_beside_gain, floor_of, gain_of, leniency
from rig.analysis.tracing.floor.rubbing import Rubbing
from rig.analysis.tracing.floor.uncertain import beside, is_inferred, of_the_inertia
from rig.analysis.tracing.thresholds import CHANCE, EXPLAINED, LENIENT, MISSING, RUBS_ANEW, TURNED
from rig.model.effect import Array


@dataclass(frozen=True)
class HeldOut:
    """Held-out blocks with their floors. Nothing here goes back into the fit."""

    runs: tuple[int, ...]
    floors: dict[Key, float]
    seen: dict[Key, float]  # floors of the fitted blocks
    lenient: dict[Key, float]  # how much more than others a single block may exceed its floor by chance
    gains: dict[Key, float]  # what a torque sensor's gain may do along T in a lock test, rad per N·m
    inferred: frozenset[Key] = frozenset()  # blocks that lean on orders of θ̃_p which nobody has read
    friction: Scattering = field(default_factory=Scattering)  # of the motor's friction from run to run
    rubs: Mapping[Key, float] = field(default_factory=dict)  # share of that in the square of a floor
    calm: bool = False  # the baseline alone is at the floor
    rubbing: Mapping[Key, Rubbing] = field(default_factory=dict)  # of the blocks in `rubs` that are no reversals

    def residuals(self, s: Solution, d: Design, left: Mapping[Key, Array] | None = None) -> dict[Key, Array]:
        """Of a solution on the held-out design `d`; of lock tests without what a gain's tolerance makes along T, nor
        what is not known of a kinematic error that nobody read, nor of the inertia where the motor turns back. `left`
        is what the solution leaves there, if that is known."""
        left = left or {key: d.residual(key, s.x) for key in d.y}
        e = {key: self._beside_gain(key, left[key], d) for key in d.y}
        if inferred := self.inferred & e.keys():
            known = scatter(s)
            e |= {key: beside(e[key], d, key, known, self.floors[key]) for key in inferred}
        if turned := [key for key in e if key[1] == "R"]:
            known = of_the_inertia(s)
            e |= {key: beside(e[key], d, key, known, self.floors[key]) for key in turned}
        return e

    def _beside_gain(self, key: Key, e: Array, d: Design) -> Array:
        if key not in self.gains:
            return e
        baseline = d.parts[key][0]
        torque = baseline.z.times((baseline.at == INDEX["compliance"]).astype(float))
        slope = float(torque @ e) / max(float(torque @ torque), 1e-300)
        return np.asarray(e - np.clip(slope, -self.gains[key], self.gains[key]) * torque)

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
        most, one = self.beyond_chance(e)
        return most > EXPLAINED or one > single

    def worst(self, e: Mapping[Key, Array]) -> tuple[float, float]:
        """Largest RMS over floor of a channel, and of a single run in a channel beside what chance does to it."""
        return max(self.ratio(e, keys) for keys in _by_channel(e)), self._worst_run(e)

    def beyond_chance(self, e: Mapping[Key, Array]) -> tuple[float, float]:
        """The same beside what chance does to the rows of a channel too, where they are few. Reversals of one run whose
        floor others' repeats stand for are judged as that run alone."""
        many = [k for k in _by_channel(e) if k[0][1] != "R" or len(k) > 1 or self.lenient[k[0]] < LENIENT]
        most = max((self.beside_chance(e, keys) for keys in many), default=0.0)
        return most, self._worst_run(e)

    def beside_chance(self, e: Mapping[Key, Array], keys: Sequence[Key], usual: float = EXPLAINED) -> float:
        """RMS over floor of blocks of one channel, over how much more than the `usual` limit it may be by chance: of
        few rows, and where friction makes much of the floor."""
        rows = np.array([e[k].size for k in keys])
        shares = np.array([self.rubs.get(k, 0.0) for k in keys]) * rows / rows.sum()
        rubs = min(self.friction.of_a_channel(shares) / usual, LENIENT)
        return self.ratio(e, keys) / max(_by_chance(int(rows.sum())), rubs)

    def _worst_run(self, e: Mapping[Key, Array]) -> float:
        whole = (self.ratio(e, [k]) / self.lenient[k] for k in e)
        return max(*whole, *(self.rubbing[k].over(e[k]) for k in e if k in self.rubbing), 0.0)


def _by_channel(e: Mapping[Key, Array]) -> list[list[Key]]:
    return [keys for c in CHANNELS if (keys := [k for k in e if k[1] == c])]


def _by_chance(rows: int) -> float:
    """By how much more than others so many rows may exceed the floor by chance, 1 where there are many: of 15 at the
    reversals of a third of one run 1.54 times it is no more than noise does."""
    return max(float(np.sqrt(chdtri(rows, 1 - CHANCE) / rows)) / EXPLAINED, 1.0)


def held_out_blocks(eq: Equations, measured: Measured, runs: Sequence[int]) -> HeldOut:
    """The held-out blocks, each with the floor of its condition."""
    floors = {key: floor_of(measured, eq, key) for key in eq.of(range(len(eq.runs)))}
    held = set(eq.of(runs))
    seen = {key: floor for key, floor in floors.items() if key not in held}
    rubs = _rubs(eq, measured, {key: floor for key, floor in floors.items() if key in held and key[1] in "MR"})
    lenient = {key: _lenient(measured, eq, key, rubs.get(key, 0.0)) for key in held}
    # without repeats of a lock test the gain may be all that its floor is known by
    repeated = any(eq.runs[i].locked for i, c in measured.by_run if c == "A")
    wound = [key for key in held if repeated and eq.runs[key[0]].locked and not eq.runs[key[0]].look.held_load]
    gains = {key: g for key in wound if (g := gain_of(measured, eq, key)) > 0}
    inferred = frozenset(key for key in held if is_inferred(eq, key))
    floors |= {key: floor_beside_gain(measured, eq, key) for key in gains}
    mine = {key: floors[key] for key in eq.of(runs)}
    rubbing = {key: _rubbing(eq, measured, key, mine[key]) for key in rubs if key[1] == "M"}
    return HeldOut(tuple(runs), mine, seen, lenient, gains, inferred, measured.friction, rubs, rubbing=rubbing)


def _rubbing(eq: Equations, measured: Measured, key: Key, floor: float) -> Rubbing:
    own = floor**2 * (1.0 - measured.friction.share(eq.runs[key[0]], floor))
    least = measured.noise.sigma["M"]  # what pairs differ by beside their friction, few of them
    return Rubbing(at_rows(eq, key, "way"), max(float(np.sqrt(own)), least), leniency(measured, eq, key))


def _rubs(eq: Equations, measured: Measured, floors: Mapping[Key, float]) -> dict[Key, float]:
    """Which share of the squares of `floors` of the motor torque is friction's that scatters; none is left out."""
    found = {key: measured.friction.share(eq.runs[key[0]], floor) for key, floor in floors.items()}
    return {key: share for key, share in found.items() if share}


def _lenient(measured: Measured, eq: Equations, key: Key, rubs: float) -> float:
    return max(leniency(measured, eq, key), min(measured.friction.of_one_run(rubs) / MISSING, RUBS_ANEW))


def unseen(s: Solution, at: HeldOut) -> Design:
    """The model's columns on the held-out runs."""
    return design(replace(s.design.eq, noisy={}), s.design.terms, at.runs)


def left_unseen(s: Solution, at: HeldOut) -> dict[Key, Array]:
    """What a solution leaves on the held-out runs, (n,) by block, one run's columns at a time: of a form of hundreds of
    numbers those of all runs are gigabytes."""
    eq = replace(s.design.eq, noisy={})
    left: dict[Key, Array] = {}
    for run in at.runs:
        left |= at.residuals(s, design(eq, s.design.terms, (run,)))
    return left
