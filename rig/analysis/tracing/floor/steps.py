"""Steps where an encoder lost counts: each run has its own."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key, Term, orthonormal
from rig.analysis.tracing.floor.jumps import EDGE, FAR, ONE, WINDOW, Mask, among, heights, jumps, one_of_size, without
from rig.analysis.tracing.floor.kept import kept
from rig.analysis.tracing.floor.local import clock
from rig.analysis.tracing.runs.alike import alike
from rig.analysis.tracing.runs.holdout import whole_run
from rig.analysis.tracing.thresholds import STEP, STEP_AGAIN, STEP_ALIKE
from rig.core.quantiles import Z95
from rig.model.effect import Array, Parameter, parameter
from rig.model.effects import EACH_RUN
from rig.model.effects.missed_counts import LOAD, MOTOR

LOST = EACH_RUN["missed_counts"]
REACH = WINDOW + EDGE  # rows on either side of a jump that are compared
APART = 5.0  # usual steps between two rows: something was left out there
SEEN_ROUND = 0.5  # length of the mean of all angles as unit vectors: half a turn and more was seen
ONE_ANGLE = 4.6  # n·R² beyond which chance gets once in a hundred times, −ln 0.01
OF_MANY = 9.2  # the same once in ten thousand times, of MORE jumps: at one angle they have n, and are there in all runs
MORE = 10
IN_THE_TORQUE = 0.5  # of a jump, which the torque sensor shows too
AS_FAST = 0.2  # relative: ripple of a speed loop is less, a stop within a held-out part more
SAME_SPEED = 0.1  # relative: steps of speed are larger, ripple within a sixth of a second smaller
OF_MEDIAN = 1.25  # standard error of a median over that of a mean, √(π/2)
AT_ONCE = 0.1  # s since the start: two repeats that jump so near each other jump because of what they do then
AT_LEAST = 0.5  # of all there is, or of what is taken, the excess that is believed
FEWER = 0.5  # of the smallest of a few jumps that are certain, another may be: two counts beside three, and noise
MANY = 4  # jumps that are certain: where all are of one size, a jump at a reversal may be another of them


@dataclass(frozen=True)
class Steps:
    """Rows of A where a run jumps, by how much [rad], the encoder that lost the counts at each
    (`missed_counts.LOAD` …), and the standard error of how much."""

    rows: dict[int, tuple[int, ...]]
    sizes: dict[int, tuple[float, ...]]
    sides: dict[int, tuple[float, ...]]
    errors: dict[int, tuple[float, ...]]

    def parameters(self) -> tuple[Parameter, ...]:
        """Number of steps and, of each encoder that made some, their usual size at the output."""
        sizes, sides, errors = (np.concatenate(list(x.values())) for x in (self.sizes, self.sides, self.errors))
        made = {name: sides == side for side, name in ((LOAD, "l"), (MOTOR, "m")) if (sides == side).any()}
        usual = (_usual(name, np.abs(sizes[mine]), errors[mine]) for name, mine in made.items())
        return (parameter("steps", float(sizes.size), 0.0, "1"), *usual)


def _usual(name: str, sizes: Array, errors: Array) -> Parameter:
    """Their median, known by how they scatter or by how well each is."""
    each = max(float(np.std(sizes)), float(np.sqrt(np.mean(errors**2))))
    half = Z95 * each * (OF_MEDIAN if sizes.size > 2 else 1.0) / np.sqrt(sizes.size)
    return parameter(f"step_theta_{name}", float(np.median(sizes)), half, "rad")


def find_steps(eq: Equations, e: Mapping[Key, Array], compliance: float = 0.0) -> Steps:
    """Sharp permanent jumps of A in each run of `e`, but for those the torque sensor shows as well: a torque that comes
    and goes winds the gear of `compliance` [rad/(N·m)] up, or seems to."""
    keys = [k for k in e if k[1] == "A"]
    onward = {key: _onward(eq, key) for key in keys}
    for key in keys:  # a motor whose speed ripples: what is certain, and stays to the end of the run
        onward[key] = onward[key] | _certain(e[key], _onward_rippling(eq, key))
    sure = [abs(size) for key in keys for _, size in _sure(e[key], onward[key])]
    # once it is known how many counts are lost at a time, smaller evidence of the same loss will do
    usual = float(np.median(sure)) if sure else 0.0
    of_one_size = len(sure) >= MANY and min(sure) > ONE * usual  # groups of counts may be lost as well
    least = ONE * usual if of_one_size else FEWER * min(sure, default=0.0)
    rows: dict[int, tuple[int, ...]] = {}
    sizes: dict[int, tuple[float, ...]] = {}
    of_the_torque = 0
    for key in keys if sure else []:
        where = onward[key] | _for_good(e[key], usual) if of_one_size else onward[key]
        again = (e[key], where, STEP_AGAIN, (least, max(1.35 * usual, 1.1 * max(sure))))
        found = jumps(*again) or jumps(*again, window=FAR)
        if of_one_size:
            found = among(e[key], onward[key], found, usual)
        elif found:
            found = sorted([*found, *kept(e[key], eq.rows[key].theta_m, found)])
        seen = len(found)
        found = [(at, size) for at, size in found if not _of_the_torque(eq, e, key, at, size, compliance)]
        of_the_torque += seen - len(found)
        if found and _lasts(eq, e, key, found):
            rows[key[0]] = tuple(at for at, _ in found)
            sizes[key[0]] = tuple(size for _, size in found)
    told = {run: at for run, at in rows.items() if (run, "L") in e}
    if of_the_torque > sum(map(len, told.values())):
        rows = told  # a lock test has no balance of the load to tell by: there they are what they are in the others
        sizes = {run: sizes[run] for run in rows}
    for run, more in _in_other_parts(eq, e, rows, sizes).items():
        found = sorted([*zip(rows.get(run, ()), sizes.get(run, ()), strict=True), *more])
        rows[run], sizes[run] = tuple(at for at, _ in found), tuple(size for _, size in found)
    return placed(eq, e, rows)


def placed(eq: Equations, e: Mapping[Key, Array], about: Mapping[int, Sequence[int]]) -> Steps:
    """Jumps of A near those rows of each run, where all channels of `e` together have them, and as high as they are."""
    found = {run: [_placed(eq, e, run, row) for row in at] for run, at in about.items()}
    rows = {run: tuple(row for row, _ in each) for run, each in found.items()}
    high = {run: heights(e[run, "A"], at) for run, at in rows.items()}
    sizes, errors = ({run: tuple(of[i] for of in each) for run, each in high.items()} for i in (0, 1))
    return Steps(rows, sizes, {run: tuple(side for _, side in each) for run, each in found.items()}, errors)


def _sure(e: Array, onward: Mask) -> list[tuple[int, float]]:
    """Jumps that nothing else makes, by the usual window, or where it shows none by a longer one: a single count or two
    of a fine encoder are in the noise of a third of a second."""
    every = (0.0, np.inf)
    return jumps(e, onward, STEP, every) or jumps(e, onward, STEP, every, window=FAR)


def _certain(e: Array, going: Mask) -> Mask:
    """Rows (n,) of jumps where the motor is `going` on that nothing else makes, and after which all the rest of the run
    is as far off."""
    out = np.zeros(e.size, bool)
    for row, size in _sure(e, going):
        out[row] = _for_good(e, abs(size))[row]
    return out


def _in_other_parts(
    eq: Equations, e: Mapping[Key, Array], rows: Mapping[int, Sequence[int]], sizes: Mapping[int, Sequence[float]]
) -> dict[int, list[tuple[int, float]]]:
    """The jumps of a run in those of its parts in which they were not found: in a few seconds of noise one does not
    stand out by itself, but when it was is known, and how large."""
    out: dict[int, list[tuple[int, float]]] = {}
    for run, at in rows.items():
        t, whole = clock(eq, (run, "A")), whole_run(eq.runs[run].name)
        others = [i for i, c in e if c == "A" and i != run and whole_run(eq.runs[i].name) == whole]
        for (row, size), other in itertools.product(zip(at, sizes[run], strict=True), others):
            when = t[max(row - EDGE, 0)], t[min(row + EDGE, t.size - 1)]
            first, last = np.searchsorted(clock(eq, (other, "A")), when)
            known = [*zip(rows.get(other, ()), sizes.get(other, ()), strict=True), *out.get(other, ())]
            if any(first - EDGE <= there <= last + EDGE for there, _ in known):
                continue
            if found := one_of_size(without(e[other, "A"], known), range(first, last + 1), size):
                out.setdefault(other, []).append(found)
    return out


def _lasts(eq: Equations, e: Mapping[Key, Array], key: Key, found: Sequence[tuple[int, float]]) -> bool:
    """Whether the other parts of the run, before and after each jump, are apart by as much [rad]: counts are lost for
    good, and what goes up on a bump comes down again. A run that is no part tells by itself."""
    whole, mine = whole_run(eq.runs[key[0]].name), clock(eq, key)
    rows, sizes = np.array([at for at, _ in found]), np.array([size for _, size in found])
    # of a part, what lies between two rows may be long
    since, until = mine[np.maximum(rows - 2 * EDGE, 0)], mine[np.minimum(rows + 2 * EDGE, mine.size - 1)]
    for other in [k for k in e if k[1] == "A" and k != key and whole_run(eq.runs[k[0]].name) == whole]:
        t = clock(eq, other)
        for first, last in zip(since, until, strict=True):
            before, after = np.flatnonzero(t < first)[-2 * WINDOW :], np.flatnonzero(t > last)[: 2 * WINDOW]
            if min(before.size, after.size) < WINDOW:
                continue
            gone = float(sizes[(since > t[before[-1]]) & (until < t[after[0]])].sum())
            if abs(float(e[other][after].mean() - e[other][before].mean()) - gone) > 0.5 * abs(gone):
                return False
    return True


def _of_the_torque(eq: Equations, e: Mapping[Key, Array], key: Key, row: int, size: float, compliance: float) -> bool:
    """Whether the torque jumps to stay with the angle. Lost counts seem to accelerate the load for a moment alone."""
    other = (key[0], "L")
    if compliance <= 0 or other not in e:
        return False
    at = int(np.searchsorted(clock(eq, other), clock(eq, key)[row]))
    before, after = e[other][max(0, at - EDGE - FAR) : max(0, at - EDGE)], e[other][at + EDGE : at + EDGE + FAR]
    if min(before.size, after.size) < WINDOW // 2:
        return False
    return abs(float(after.mean() - before.mean())) * compliance > IN_THE_TORQUE * abs(size)


def _placed(eq: Equations, e: Mapping[Key, Array], run: int, about: int) -> tuple[int, float]:
    """The row of a jump, and the encoder: those whose step explains most of all channels together. A reading that jumps
    seems to accelerate its own inertia, and tells by that when it did; in A the two encoders are the same."""
    last = eq.rows[run, "A"].y.size - 1
    rows = range(max(1, about - EDGE), min(last, about + EDGE) + 1)
    return max(((row, side) for row in rows for side in (LOAD, MOTOR)), key=lambda at: _gained(eq, e, run, *at))


def _gained(eq: Equations, e: Mapping[Key, Array], run: int, row: int, side: float) -> float:
    """Sum of squares over the noise's that a step of one size takes from all channels of a run."""
    along = work = 0.0
    for c, made in made_by(eq, run, row, side).items():
        if (run, c) in e and np.any(made):
            column = eq.without_offset((run, c), made)[:, 0]
            along += float(column @ e[run, c]) * eq.noise.weight(c)
            work += float(column @ column) * eq.noise.weight(c)
    return along**2 / max(work, 1e-300)


def made_by(eq: Equations, run: int, row: int, side: float) -> dict[str, Array]:
    """What a jump makes in each channel of a run, (n, 1)."""
    t = clock(eq, (run, "A"))
    return dict(eq.term(run, Term(LOST, (side, 0.5 * (t[row] + t[max(row - 1, 0)])))))


def _onward(eq: Equations, key: Key) -> Mask:
    """True for rows with a window on both sides in which the motor neither turned back nor rested, and goes on at one
    speed, (n,).

    At a reversal everything with memory or play goes over to its other branch, and some of it where the load is
    accelerated: that looks like a step and is none.
    """
    theta, t = eq.rows[key].theta_m, clock(eq, key)
    return _unturned(theta, t) & _at_one_speed(theta, t, REACH)


def _onward_rippling(eq: Equations, key: Key) -> Mask:
    """The same where its speed may ripple, and is the same in the mean before and after."""
    theta, t = eq.rows[key].theta_m, clock(eq, key)
    return _unturned(theta, t) & _as_fast(theta, t, 2 * REACH)


def _unturned(theta: Array, t: Array) -> Mask:
    """Rows (n,) as far as REACH from which the motor neither turned back nor rested."""
    way = np.sign(np.diff(theta, prepend=theta[0]))
    turned = np.concatenate([[0], np.cumsum(np.abs(np.diff(_filled(way))) > 0) + np.cumsum(_rested(theta, t))])
    first, last = np.maximum(np.arange(t.size) - REACH, 0), np.minimum(np.arange(t.size) + REACH, t.size - 1)
    return np.asarray(turned[first] == turned[last])


def _for_good(e: Array, size: float) -> Mask:
    """True for rows between which and the end of the run all is on average `size` [rad] off what was before, (n,). What
    goes over to another branch at a reversal comes back at the next."""
    n = np.arange(1, e.size + 1)
    total = np.cumsum(e)
    off = np.abs((total[-1] - total) / np.maximum(e.size - n, 1) - total / n)
    return np.asarray((off > ONE * size) & (off < 1.35 * size))


def _at_one_speed(theta: Array, t: Array, reach: int) -> Mask:
    """Rows (n,) around which the mean speed is the same in half windows as far as one and a half times `reach` rows."""
    rows = np.arange(t.size)
    edges = [np.clip(rows + share * reach // 2, 0, t.size - 1) for share in range(-3, 4)]
    gone = [theta[b] - theta[a] for a, b in itertools.pairwise(edges)]
    took = [np.maximum(t[b] - t[a], 1e-12) for a, b in itertools.pairwise(edges)]
    speed = np.abs(np.array(gone) / np.array(took))
    return np.asarray(np.ptp(speed, axis=0) <= SAME_SPEED * speed.max(0))


def _as_fast(theta: Array, t: Array, reach: int) -> Mask:
    """Rows (n,) before which the mean speed of `reach` rows is that of as many after."""
    rows = np.arange(t.size)
    before, after = np.maximum(rows - reach, 0), np.minimum(rows + reach, t.size - 1)
    speeds = np.abs(
        [(theta[b] - theta[a]) / np.maximum(t[b] - t[a], 1e-12) for a, b in ((before, rows), (rows, after))]
    )
    return np.asarray(np.ptp(speeds, axis=0) <= AS_FAST * speeds.max(0))


def _rested(theta: Array, t: Array) -> Array:
    """Whether the motor may have done something else between two rows (n − 1,): rows are left out there, and it did not
    go on as fast as around them. Where it did, the rows between are only held out."""
    gap, gone = np.diff(t), np.diff(theta)
    usual = float(np.median(gap))
    open_ = gap > APART * usual
    rate = gone / gap
    around = np.median(np.abs(rate[~open_])) if (~open_).any() else 0.0
    return np.asarray(open_ & (np.abs(np.abs(rate) - around) > AS_FAST * around))


def _filled(way: Array) -> Array:
    """Zeros replaced by the way before them: two rows on one count are no turning back."""
    at = np.maximum.accumulate(np.where(way != 0, np.arange(way.size), 0))
    return np.asarray(way[at])


def lost_counts(eq: Equations, steps: Steps, pairs: Sequence[tuple[int, int]]) -> bool:
    """Whether the jumps are lost counts: there are some, and repeats do not jump at the same angle as a tooth would
    or at the same moment of what they do, nor all runs at one angle of a shaft as a scale with a fault would."""
    count = sum(len(r) for r in steps.rows.values())
    if count == 0 or any(_at_one_angle(eq, steps, per_turn) for per_turn in (1.0, eq.runs[0].ratio)):
        return False
    same = 0
    for a, b in pairs:
        (x, t), (y, u) = (_at(eq, i, steps.rows.get(i, ())) for i in (a, b))
        near = (np.abs(x[:, None] - y) < STEP_ALIKE) | (np.abs(t[:, None] - u) < AT_ONCE)
        same += int(near.any(1).sum())
    return same * 4 < count


def _at(eq: Equations, run: int, rows: Sequence[int]) -> tuple[Array, Array]:
    """Motor angles [rad] and times since the start of the run [s] of some rows of A."""
    t = clock(eq, (run, "A"))
    return eq.rows[run, "A"].theta_m[list(rows)], t[list(rows)] - (t[0] if t.size else 0.0)


def _at_one_angle(eq: Equations, steps: Steps, per_turn: float) -> bool:
    """Whether the jumps lie nearer together on a shaft that turns once in `per_turn` turns of the motor than chance
    does once in a hundred times (Rayleigh's test, about the mean of what the runs saw of it), and not because they saw
    no more of that shaft."""
    thetas = [eq.rows[run, "A"].theta_m for run in steps.rows]
    jumps = np.concatenate([theta[list(rows)] for theta, rows in zip(thetas, steps.rows.values(), strict=True)])
    seen, found = (np.mean(np.exp(1j * x / per_turn)) for x in (np.concatenate(thetas), jumps))
    apart = abs(found - seen) ** 2 / (1.0 - min(abs(seen) ** 2, SEEN_ROUND))
    least = ONE_ANGLE if jumps.size < MORE else OF_MANY
    return bool(abs(seen) < SEEN_ROUND and jumps.size * apart > least)


def step_columns(eq: Equations, steps: Steps) -> dict[Key, Array]:
    """One column a jump in every channel it shows in, (n, jumps)."""
    out: dict[Key, Array] = {}
    for run, rows in steps.rows.items():
        made = [made_by(eq, run, row, side) for row, side in zip(rows, steps.sides[run], strict=True)]
        for c in {c for m in made for c, x in m.items() if np.any(x)}:
            out[run, c] = np.hstack([m[c] for m in made if c in m and np.any(m[c])])
    return out


def explained(eq: Equations, e: Mapping[Key, Array], columns: Mapping[Key, Array]) -> float:
    """Share of what is left in A beyond a run's repeats that columns of their own take, in the blocks of `e` that have
    some; of one that has no repeat without them, beyond the floor. What a step does to the torques is no measure: it
    has another unit, and is hardly seen there. Nor is the mean of a run: it is where its encoders began to count."""
    taken = square_taken(e, columns)
    e = {key: x - x.mean() for key, x in e.items() if key[1] == "A"}
    excess = sum(_excess(eq, e, key, taken.keys(), work) for key, work in taken.items())
    return sum(taken.values()) / max(excess, 1e-300)


def square_taken(e: Mapping[Key, Array], columns: Mapping[Key, Array]) -> dict[Key, float]:
    """Sum of squares about its mean that columns of their own take of each block of A that has some, rad²."""
    own = {key: orthonormal(x - x.mean(0)) for key, x in columns.items() if key in e and key[1] == "A"}
    return {key: float(np.sum((q.T @ (e[key] - e[key].mean())) ** 2)) for key, q in own.items()}


def _excess(eq: Equations, e: Mapping[Key, Array], key: Key, own: Collection[Key], taken: float) -> float:
    """Sum of squares of a block beyond what it has without its jumps, which take so much of it. Jumps raise a floor
    that turns of one run tell, even above themselves: of that floor no more than a half is believed. Nor does a repeat
    tell that is about as loud as the run with them."""
    run, whole = eq.runs[key[0]], float(e[key] @ e[key])
    others = [k for k in e if k[1] == "A" and k not in own and whole_run(eq.runs[k[0]].name) != whole_run(run.name)]
    like = [float(np.mean(e[k] ** 2)) for k in others if alike(eq.runs[k[0]], run)]
    if like and (over := whole - e[key].size * float(np.median(like))) > AT_LEAST * taken:
        return over
    return max(whole - e[key].size * eq.noise.sigma["A"] ** 2, AT_LEAST * whole)
