"""Noise of each channel: from repeats where there are some, else from neighbouring turns and strokes of one run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from rig.analysis.tracing.fit.channels import BASELINE, CHANNEL, CHANNELS, WHOLE
from rig.analysis.tracing.fit.equations import Equations, Key, Noise
from rig.analysis.tracing.fit.model import Design, Solution
from rig.analysis.tracing.floor.friction import Scattering, evened
from rig.analysis.tracing.floor.homed import about_a_line
from rig.analysis.tracing.floor.known import known
from rig.analysis.tracing.floor.neighbours import neighbours, turn_by_turn
from rig.analysis.tracing.floor.offsets import own_angle, own_offset
from rig.analysis.tracing.floor.outlying import outlying
from rig.analysis.tracing.floor.repeats import Scatter, effective, scatter
from rig.analysis.tracing.floor.rounded import rounded
from rig.analysis.tracing.floor.steady import steady
from rig.analysis.tracing.floor.stroke_by_stroke import beside_the_angle
from rig.analysis.tracing.runs.alike import as_fast, repeats
from rig.analysis.tracing.runs.holdout import whole_run
from rig.analysis.tracing.thresholds import BEYOND, TURNED_BACK
from rig.model.effect import Array

FINEST = 1e-5  # of what a channel swings by, RMS: no rig repeats better, and numbers made up without noise do
NEVER_COMPARED = "lock tests alone, none of them done twice: all that is left counts as noise"
TOO_SHORT = "too few turns to compare them: all that is left counts as noise"
BY_SENSORS = ", where they differ by less than the noise of the readings: that is taken"
A_FEW = 2  # runs: where none of more can be compared, what is rough in them has to do, or nothing would be found
BY_COUNTS = ", which is less than the rounding of the readings leaves: that is taken"
SWOLLEN = 1.2  # times the floor that is believed, from which on it is said that a run's own was not
LEAST_OFFSET = 0.25  # of the floor, RMS: a dozen pairs do not show less, and no mean is worth more rows than that


@dataclass(frozen=True)
class Measured:
    """The noise to weight with, and what it was measured on: RMS by run (a repeated one) and channel. `white` is the
    part that sensors make, in the few runs it is known of."""

    noise: Noise
    by_run: dict[Key, float]
    white: dict[Key, float]
    how: dict[str, str]
    freedom: dict[Key, float]  # degrees of freedom of the RMS of a pair of repeats
    apart: frozenset[Key] = frozenset()  # whose repeats differ by more than noise: no other condition's floor
    friction: Scattering = field(default_factory=Scattering)
    interval: dict[str, tuple[float, float]] = field(default_factory=dict)  # 95 %, of the RMS of a channel
    beyond: float = np.inf  # times the noise of its sensors, from which on what L differs by is no noise

    def never_compared(self) -> list[str]:
        """What is said where the floor of a channel is all that was left in it."""
        names = [CHANNEL[c].name for c, how in self.how.items() if how == TOO_SHORT]
        if not names:
            return []
        return [
            f"The floor (of {', '.join(names)}) is all that the baseline leaves: no turn or stroke could be compared "
            "with another, and an effect of that size is not seen. Longer runs, or the same once more, tell more."
        ]


def guess(eq: Equations) -> Noise:
    """Before anything is fitted: what is rough in the responses."""
    sigma: dict[str, float] = {}
    for channel in WHOLE:
        rough = [np.diff(r.y, 4) for (_, c), r in eq.rows.items() if c == channel]
        spread = float(np.median(np.abs(np.concatenate(rough)))) if rough else 1.0
        sigma[channel] = max(spread / 0.6745 / np.sqrt(70) * 2, finest(eq, channel))  # twice: half is the low-pass's
    return _at_reversals(Noise(sigma, dict.fromkeys(CHANNELS, 4.0), dict.fromkeys(CHANNELS, np.inf)))


def finest(eq: Equations, channel: str) -> float:
    """The least floor that is believed: made-up numbers, and repeats that a coarse encoder rounds alike, have none at
    all."""
    mine = {i: r.y for (i, c), r in eq.rows.items() if c == channel}
    swing = float(np.sqrt(np.mean(np.concatenate([y - y.mean() for y in mine.values()]) ** 2))) if mine else 0.0
    return max(FINEST * swing, rounded(eq, channel), 1e-12)


def measure(solution: Solution, among: Sequence[int]) -> Measured:
    """Floor of every channel from the runs `among`, from the residuals of a model that repeats share."""
    eq, e = solution.design.eq, {key: solution.residual(key) for key in solution.keys}
    pairs = repeats(eq.runs, among)
    sigma, kappa, local = dict(eq.noise.sigma), dict(eq.noise.kappa), dict(eq.noise.local)
    by_run: dict[Key, float] = {}
    free: dict[Key, float] = {}
    how: dict[str, str] = {}
    apart: set[Key] = set()
    interval: dict[str, tuple[float, float]] = {}
    friction = Scattering()
    design = solution.design
    white = _white(design, solution.x)
    # terms that go by a reading, and trade what they explain, would add theirs many times
    of_the_sensors = _white(design, np.where(np.arange(design.size) < len(BASELINE), solution.x, 0.0))
    beyond = np.inf
    for channel in WHOLE:
        found, words = _compared(eq, e, channel, pairs, among)
        if channel == "L":
            beyond = BEYOND * _quietest(eq, e, channel, of_the_sensors, found)
        found, said = _as_sensors_tell(eq, found, channel, of_the_sensors, beyond if channel == "L" else np.inf)
        words += said
        if not found:
            if (left := _locked_alone(eq, e, channel)) is not None:
                sigma[channel], how[channel] = max(sigma[channel], left), NEVER_COMPARED
            elif (left := _of_a_few(eq, e, channel)) is not None:
                sigma[channel], how[channel] = max(sigma[channel], left), TOO_SHORT
            continue
        if channel == "M":
            found, friction = evened(solution, found, sigma["M"] ** 2 * kappa["M"])
            words += friction.words()
        far = outlying(eq, found)
        how[channel] = words + _said(eq, far)
        usual = [s for s in found if s not in far]
        n = np.array([s.rows for s in usual])
        least = finest(eq, channel)
        among_them = float(np.sqrt(np.average([s.rms**2 for s in usual], weights=n)))
        sigma[channel] = max(among_them, least)
        how[channel] += BY_COUNTS if among_them < least else ""
        interval |= {channel: known(usual)} if among_them >= least else {}
        kappa[channel] = effective(np.average([s.rho / max(s.rho[0], least**2) for s in usual], axis=0, weights=n))
        apart |= {(i, channel) for s in far for i in s.pair}
        compared = [*_alone(eq, e, channel, among, found), *found]
        how[channel] += _swollen(eq, compared)
        by_run |= {(i, channel): max(s.rms, least) for s in compared for i in s.pair}
        free |= {(i, channel): s.freedom for s in found for i in s.pair}
        by_run |= _never_compared(eq, e, channel, among, found, friction)
        local[channel] = own_offset(solution, channel, usual, sigma[channel] ** 2 * kappa[channel])
    local["A"] = own_angle(solution, pairs, sigma["A"] * LEAST_OFFSET)
    if zeros := eq.runs[0].look.zeros:
        local["A"] = about_a_line(solution) or zeros
    turned = max((rms for (_, c), rms in white.items() if c == "R"), default=0.0)
    noise = _at_reversals(Noise(sigma, kappa, local), turned)
    return Measured(noise, by_run, white, how, free, frozenset(apart), friction, interval, beyond)


def _locked_alone(eq: Equations, e: Mapping[Key, Array], channel: str) -> float | None:
    """RMS of all that is left in A where only locked runs have it, whose load angle nobody read; None elsewhere. That
    load is taken to be at rest, and what its encoder's noise would be says nothing of it."""
    keys = [key for key in e if key[1] == channel]
    unread = all(eq.runs[i].locked and "theta_l" not in eq.runs[i].has for i, _ in keys)
    if channel != "A" or not keys or not unread:
        return None
    return _rms(e, keys)


def _of_a_few(eq: Equations, e: Mapping[Key, Array], channel: str) -> float | None:
    """RMS of all that is left of a channel where there is a run alone, or one and the proof before it, and the output
    turned; None elsewhere. What is rough in them is a part of their noise, and the whole would be many times that."""
    keys = [key for key in e if key[1] == channel]
    turning = [run for run in eq.runs if run.procedure != "standstill"]
    if not keys or len({whole_run(run.name) for run in turning}) > A_FEW or any(run.locked for run in turning):
        return None
    return _rms(e, keys)


def _rms(e: Mapping[Key, Array], keys: Sequence[Key]) -> float:
    return float(np.sqrt(np.mean(np.concatenate([e[key] for key in keys]) ** 2)))


def _compared(
    eq: Equations, e: Mapping[Key, Array], channel: str, pairs: Sequence[tuple[int, int]], among: Sequence[int]
) -> tuple[list[Scatter], str]:
    """What repeats differ by, or where there are none neighbouring turns or strokes of one run, and how in words."""
    if found := [s for pair in pairs if (s := scatter(eq, e, pair, channel)) is not None]:
        return found, f"{len(found)} pair{'s' if len(found) > 1 else ''} of repeats compared at equal motor angle"
    found = [s for i in among if (s := neighbours(eq, e, (i, channel))) is not None]
    found = found or [s for i in among if (s := turn_by_turn(eq, e, (i, channel))) is not None]
    many = f"{len(found)} run{'' if len(found) == 1 else 's'}"
    return found, f"neighbouring turns or strokes of {many} compared at equal motor angle, no repeats there"


def _white(d: Design, x: Array) -> dict[Key, float]:
    """RMS of what sensor noise leaves in the blocks it is known of, with coefficients `x` (p,)."""
    return {key: float(np.sqrt(np.mean(d.noise_left(key, x) ** 2))) for key in d.noise}


def of_sensors(eq: Equations, white: Mapping[Key, float], run: int, channel: str) -> float:
    """RMS of the noise of a run, of those of its procedure where its own is not known, 0 where nobody's is."""
    like = [v for (j, c), v in white.items() if c == channel and eq.runs[j].procedure == eq.runs[run].procedure]
    return white.get((run, channel), float(np.sqrt(np.mean(np.square(like)))) if like else 0.0)


def _quietest(
    eq: Equations, e: Mapping[Key, Array], channel: str, white: Mapping[Key, float], found: Sequence[Scatter]
) -> float:
    """How many times the noise of its sensors, taken to be white, is left all the time in the run that has least, or is
    what that differs by; 1 at least. All of a pink noise is more than what is rough in it, in every run."""
    left = [(i, steady(e[i, c])) for i, c in e if c == channel] + [(s.pair[0], s.rms) for s in found]
    over = [rms / sensors for i, rms in left if (sensors := of_sensors(eq, white, i, channel))]
    return max(1.0, min(over, default=1.0))


def _as_sensors_tell(
    eq: Equations, found: Sequence[Scatter], channel: str, white: Mapping[Key, float], beyond: float = np.inf
) -> tuple[list[Scatter], str]:
    """Scatter of single runs, with what their sensors' noise leaves where that is more: encoders round one turn as they
    do the next where a turn is whole counts. And what is said where it is much more. Repeats begin elsewhere. What is
    `beyond` so many times that noise is none: what is missing may begin anew each turn."""
    over = [
        s.rms / least for s in found if s.pair[0] == s.pair[1] and (least := of_sensors(eq, white, s.pair[0], channel))
    ]
    usual = float(np.median([x for x in over if x <= beyond] or [beyond]))

    def believed(s: Scatter) -> Scatter:
        """What sensors make at least, and as much as in other runs where it is many times that."""
        if s.pair[0] != s.pair[1] or not (least := of_sensors(eq, white, s.pair[0], channel)):
            return s
        if s.rms > beyond * least:
            return replace(s, rms=usual * least, swollen=s.rms / (usual * least))
        return replace(s, rms=max(s.rms, least))

    made = [believed(s) for s in found]
    much = any(new.rms > SWOLLEN * old.rms for new, old in zip(made, found, strict=True))
    return made, BY_SENSORS if much else ""


def _said(eq: Equations, far: Sequence[Scatter]) -> str:
    """The pairs that are left out, in words."""
    names = ", ".join(eq.runs[i].name for s in far for i in s.pair)
    return f"; without {names}, which differ by more than noise does" if far else ""


def _swollen(eq: Equations, compared: Sequence[Scatter]) -> str:
    """The runs whose turns differ by what is no noise, in words."""
    found = sorted((s for s in compared if s.swollen > SWOLLEN), key=lambda s: -s.swollen)
    if not found:
        return ""
    first = eq.runs[found[0].pair[0]].name
    more = f" and {len(found) - 1} more" if len(found) > 1 else ""
    return (
        f"; in {first}{more}, which nobody repeated, one turn differs from the next by up to {found[0].swollen:.2g} "
        "times as much: it goes slowly, is no noise and was left out"
    )


def _at_reversals(noise: Noise, white: float = 0.0) -> Noise:
    """With R as noisy as M, and a little more: it has too few rows to compare repeats in. And as noisy as the sensors
    make it, RMS `white`: of a coarse encoder the acceleration is used there alone."""
    sigma = noise.sigma | {"R": float(np.hypot(TURNED_BACK * noise.sigma["M"], white))}
    return Noise(sigma, noise.kappa | {"R": noise.kappa["M"]}, noise.local | {"R": noise.local["M"]})


def quieter(one: Measured, other: Measured) -> Measured:
    """Of each channel the floor that is lower, and the offset of a run's own that is smaller: beside effects that are
    there repeats differ less, not more."""
    best = {c: min((one, other), key=lambda m: m.noise.sigma[c]) for c in CHANNELS}
    noise = Noise(
        {c: m.noise.sigma[c] for c, m in best.items()},
        {c: m.noise.kappa[c] for c, m in best.items()},
        {c: min(one.noise.local[c], other.noise.local[c]) for c in CHANNELS},
    )
    by_run = {key: rms for c, m in best.items() for key, rms in m.by_run.items() if key[1] == c}
    white = {key: rms for c, m in best.items() for key, rms in m.white.items() if key[1] == c}
    how = {c: m.how[c] for c, m in best.items() if c in m.how}
    free = {key: nu for c, m in best.items() for key, nu in m.freedom.items() if key[1] == c}
    apart = frozenset(key for c, m in best.items() for key in m.apart if key[1] == c)
    interval = {c: m.interval[c] for c, m in best.items() if c in m.interval}
    return Measured(noise, by_run, white, how, free, apart, best["M"].friction, interval, best["L"].beyond)


def _alone(
    eq: Equations, e: Mapping[Key, Array], channel: str, among: Sequence[int], found: Sequence[Scatter]
) -> list[Scatter]:
    """In A, whose noise is white, runs of conditions that no pair was compared in, each beside itself: how an encoder's
    rounding averages out depends on the speed. One cycle about zero has no two strokes that pass the same angles.
    """
    if channel != "A":
        return []
    compared = {i for s in found for i in s.pair}
    rest = [i for i in among if (i, channel) in e and not any(as_fast(eq.runs[i], eq.runs[j]) for j in compared)]
    return [s for i in rest if (s := neighbours(eq, e, (i, channel)) or turn_by_turn(eq, e, (i, channel))) is not None]


def _never_compared(
    eq: Equations,
    e: Mapping[Key, Array],
    channel: str,
    among: Sequence[int],
    found: Sequence[Scatter],
    friction: Scattering,
) -> dict[Key, float]:
    """In M, locked runs of which no two were compared: what is left of each beside what goes with the angle and the
    way counts as noise, and how far friction lies apart from run to run.

    A motor that creeps against a spring sticks and slips: its friction is no other run's, and tells nothing of theirs.
    """
    compared = {eq.runs[i].procedure for s in found for i in s.pair}
    keys = [(i, "M") for i in among if eq.runs[i].locked and eq.runs[i].procedure not in compared]
    return {
        key: float(np.sqrt(np.mean(beside_the_angle(eq.rows[key].theta_m, e[key]) ** 2) + friction.of(eq.runs[key[0]])))
        for key in keys
        if channel == "M" and key in e
    }
