"""The rig's equations of all runs as blocks of rows, each run's own offsets already taken out."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np

from rig.analysis.tracing.fit.channels import CHANNELS
from rig.analysis.tracing.fit.footprint import footprint
from rig.analysis.tracing.fit.rows import Rows, is_measured, rows, shared_columns, unmasked
from rig.analysis.tracing.runs.recording import Recording
from rig.model.effect import MEASURED, Array, Effect, Known, Port, Shape
from rig.process.workers import WORKERS

Key = tuple[int, str]  # run, channel
FEWEST = 12  # rows of a run in a channel: a brisk lock test that sticks and slips is two dozen readings, and good ones


@dataclass(frozen=True)
class Noise:
    """What cannot be explained, by channel: RMS `sigma`, rows per independent row `kappa`, and how far a run's own
    offset may lie from the others' (`local`, infinite where it is free)."""

    sigma: dict[str, float]
    kappa: dict[str, float]
    local: dict[str, float]

    def weight(self, channel: str) -> float:
        """1/variance of one row when all are taken as independent."""
        return 1.0 / (self.sigma[channel] ** 2 * self.kappa[channel])

    def free(self, channel: str) -> Noise:
        """With offsets of that channel that are every run's own."""
        return replace(self, local={**self.local, channel: np.inf})

    def pull(self, channel: str, n: int) -> float:
        """How much of its mean a run of `n` rows loses: all when its offset is free."""
        own = self.local[channel]
        if not np.isfinite(own):
            return 1.0
        share = n / (n + 1.0 / (self.weight(channel) * own**2))
        return float(1.0 - np.sqrt(1.0 - share))


@dataclass(frozen=True)
class Term:
    """One effect in the model, with the shape it has there."""

    effect: Effect
    shape: Shape

    @property
    def name(self) -> str:
        """Of the effect."""
        return self.effect.name


@dataclass(frozen=True)
class Bare:
    """Columns `x` (n, k) without what a run has to itself, which are never written out as long as it can be helped: of
    the baseline there are 80 numbers a row, and many designs. `less` (k,) is taken off each, then what lies along
    `local` (n, q), orthonormal; both None of columns that are bare already.
    """

    x: Array
    less: Array | None = None
    local: Array | None = None

    def times(self, c: Array) -> Array:
        """Their sum with coefficients `c` (k,) or (k, m): (n,) or (n, m)."""
        return self._apart(self.x @ c if self.less is None else self.x @ c - self.less @ c)

    def onto(self, v: Array) -> Array:
        """Their products with `v` (n,) or (n, m): (k,) or (k, m)."""
        v = self._apart(v)
        made = self.x.T @ v
        return np.asarray(made if self.less is None else made - np.multiply.outer(self.less, v.sum(0)))

    def whole(self) -> Array:
        """Written out, (n, k)."""
        return self._apart(self.x if self.less is None else self.x - self.less)

    def _apart(self, v: Array) -> Array:
        return v if self.local is None else np.asarray(v - self.local @ (self.local.T @ v))


@dataclass(frozen=True)
class Equations:
    """`rows` of every run and channel as they are; `own` are columns (n, q) each run has to itself."""

    runs: tuple[Recording, ...]
    rows: dict[Key, Rows]
    noise: Noise
    own: dict[Key, Array] = field(default_factory=dict)
    noisy: dict[int, Recording] = field(default_factory=dict)  # a few runs with their own sensor noise once more
    stands_for: dict[Key, float] = field(default_factory=dict)  # rows all fitted runs have like it, over its own

    @property
    def timed(self) -> bool:
        """Whether all runs have a time column: else rows have no known distance, and nothing a frequency."""
        return all("t" in run.has for run in self.runs)

    def of(self, runs: Sequence[int]) -> list[Key]:
        """Keys of those runs, in order."""
        return [(i, c) for i in runs for c in CHANNELS if (i, c) in self.rows]

    @cached_property
    def local(self) -> dict[Key, Array]:
        """Columns of a run's own without its offset, orthonormal (n, q)."""
        found = {key: r.own for key, r in self.rows.items() if r.own.shape[1]}
        both = {key: np.hstack([m[key] for m in (found, self.own) if key in m]) for key in {**found, **self.own}}
        return {key: orthonormal(self.without_offset(key, x)) for key, x in both.items()}

    def without_offset(self, key: Key, x: Array) -> Array:
        """`x` (n,) or (n, k) with as much of its mean gone as the run's offset is its own; all of it in A of a locked
        run, whose clamp turns the output a little."""
        return np.asarray(x - self.share_of_mean(key, x.shape[0]) * x.mean(0))

    def share_of_mean(self, key: Key, n: int) -> float:
        """How much of the mean of `n` rows of a block is the run's own: all of a load's torque where nobody says what
        hung on it."""
        run, channel = key
        free = channel == "A" and self.runs[run].locked
        free = free or (channel == "L" and not self.runs[run].load_known)
        return 1.0 if free else self.noise.pull(channel, n)

    def bare(self, key: Key, x: Array) -> Array:
        """`x` (n,) or (n, k) without what the run has to itself."""
        return self.without_local(key, self.without_offset(key, x))

    def without_local(self, key: Key, x: Array) -> Array:
        """`x` (n,) or (n, k) without what lies along columns that no other run shares."""
        local = self.local.get(key)
        return x if local is None else np.asarray(x - local @ (local.T @ x))

    def bared(self, key: Key, x: Array) -> Bare:
        """The same of `x` (n, k), not written out."""
        return Bare(x, self.share_of_mean(key, x.shape[0]) * x.mean(0), self.local.get(key))

    def baseline(self, key: Key) -> Bare:
        """The baseline's columns of a block without what the run has to itself, not written out."""
        r = self.rows[key]
        return Bare(r.z, self.share_of_mean(key, r.y.size) * r.sums.z, self.local.get(key))

    def products(self, key: Key) -> tuple[Array, Array]:
        """Of those columns with each other (b, b) and with the response (b,). Where a share s of their mean m is the
        run's own, what stays of it adds n·(1 − s)²·m·mᵀ to products about the mean."""
        r = self.rows[key]
        if key in self.local:
            z = self.baseline(key).whole()
            return z.T @ z, z.T @ self.bare(key, r.y)
        left = r.y.size * (1.0 - self.share_of_mean(key, r.y.size)) ** 2 * r.sums.z
        return r.sums.gram + np.multiply.outer(left, r.sums.z), r.sums.right + left * r.sums.y

    def kept(self, run: int) -> dict[str, Rows]:
        """Rows of a run by channel."""
        return {c: r for c in CHANNELS if (r := self.rows.get((run, c))) is not None}

    def term(self, run: int, term: Term) -> dict[str, Array]:
        """Columns of an effect in the channels of a run (rows, k), masked, not yet bare."""
        return columns(self.runs[run], term, self.kept(run))

    def unmasked_term(self, run: int, term: Term, noisy: bool = False) -> dict[str, Array]:
        """The same in all rows, (n, k); `noisy`: with sensor noise once more."""
        return unmasked_columns(self.noisy[run] if noisy else self.runs[run], term, self.kept(run))

    def spoilt(self, run: int) -> dict[str, tuple[Array, Bare]]:
        """What sensor noise does to the response (n,) and to the baseline's columns (n, b) of one run, bare."""
        noisy, out = self.noisy[run], {}
        for c, r in self.kept(run).items():
            y, z = noisy.once(c, partial(_beside, noisy, c, r))
            out[c] = self.bare((run, c), y), self.bared((run, c), z)
        return out

    def spoilt_term(self, run: int, term: Term, clean: dict[str, Array]) -> dict[str, Array]:
        """What the same noise does to the columns of a term, whose `clean` ones are given, bare.

        Nothing where it moves a state: taken off as if it added to them, it would outweigh the columns of a motor that
        hardly moves.
        """
        if term.effect.moved_by_noise(term.shape):
            return {c: np.zeros_like(z) for c, z in clean.items()}
        noisy = columns(self.noisy[run], term, self.kept(run))
        return {c: self.bare((run, c), noisy[c] - clean[c]) for c in clean}

    def knowing(self, known: Known) -> Equations:
        """With what is known of the gear by now."""
        noisy = {i: run.knowing(known) for i, run in self.noisy.items()}
        return replace(self, runs=tuple(run.knowing(known) for run in self.runs), noisy=noisy)

    def afresh(self) -> Equations:
        """With signals of which nothing is made yet."""
        noisy = {i: run.afresh() for i, run in self.noisy.items()}
        return replace(self, runs=tuple(run.afresh() for run in self.runs), noisy=noisy)

    def leaning_on_it(self) -> Equations:
        """With the baseline's columns made again in runs that miss a sensor, whose part is made with what is known."""
        missing = [i for i, run in enumerate(self.runs) if not run.knows >= MEASURED]
        made = {(i, c): rows(self.runs[i], c) for i, c in self.rows if i in missing}
        return replace(self, rows={**self.rows, **made})


def _beside(noisy: Recording, channel: str, r: Rows) -> tuple[Array, Array]:
    """What a noisy run's response (n,) and columns (n, b) have more than those of the run itself."""
    y, z, at = unmasked(noisy, channel)
    return y[r.keep] - r.y, z[r.keep][:, shared_columns(noisy, channel, at)] - r.z


def orthonormal(x: Array) -> Array:
    """An orthonormal basis (n, q) of the columns of `x`."""
    q, r = np.linalg.qr(x)
    return np.asarray(q[:, np.abs(np.diag(r)) > 1e-6 * np.abs(r).max()])


def less(q: Array, x: Array) -> Array:
    """What an orthonormal basis `q` (n, q) leaves of columns `x` (n, k)."""
    return np.asarray(x - q @ (q.T @ x))


def acting(run: Recording, term: Term) -> list[dict[Port, Array]]:
    """What a term does along each piece, (n, k) a port. Of an effect with a state, parts of one piece are cut from what
    it does along the whole: a loop or a resonance that began anew at every cut would be another one."""
    wholes: dict[int, Mapping[Port, Array]] = {}
    out = []
    for piece in run.pieces:
        if piece.cut is None or not term.effect.has_state():
            out.append(dict(term.effect.columns(piece, term.shape)))
            continue
        whole = piece.cut.whole
        if id(whole) not in wholes:
            wholes[id(whole)] = term.effect.columns(whole, term.shape)
        out.append({port: piece.cut.of(z) for port, z in wholes[id(whole)].items()})
    return out


def columns(run: Recording, term: Term, kept: dict[str, Rows]) -> dict[str, Array]:
    """Columns of `term` in each channel of `kept`, pieces joined, rows as in `kept`."""
    joined = {c: z[kept[c].keep] for c, z in unmasked_columns(run, term, kept).items()}
    # a column of something that was not measured explains nothing
    return {c: z if np.isfinite(z).all() else np.zeros_like(z) for c, z in joined.items()}


def unmasked_columns(run: Recording, term: Term, kept: Collection[str]) -> dict[str, Array]:
    """Columns of `term` in the channels `kept`, pieces joined, all rows (n, k)."""
    acts = acting(run, term)
    made = [
        footprint(act, piece, run.smoother, run.knows, run.look.held_load, run.is_wound)
        for act, piece in zip(acts, run.pieces, strict=True)
    ]
    if len(made) == 1:
        return {c: made[0][c] for c in kept if c in made[0]}
    return {c: np.concatenate([m[c] for m in made]) for c in kept if c in made[0]}


def equations(runs: Sequence[Recording], noise: Noise) -> Equations:
    """Rows of all runs and the channels they measured."""

    def of(i: int) -> dict[Key, Rows]:
        made = {(i, c): rows(runs[i], c) for c in CHANNELS if is_measured(runs[i], c)}
        return {key: r for key, r in made.items() if r.y.size >= FEWEST}

    with ThreadPoolExecutor(WORKERS) as pool:
        found = list(pool.map(of, range(len(runs))))
    return Equations(tuple(runs), {key: r for part in found for key, r in part.items()}, noise)


def spoiling(eq: Equations, fitted: Sequence[int]) -> Equations:
    """With a second helping of sensor noise for a few of the fitted runs, which stand for all of them.

    Of each procedure the run that turns fastest and the one that turns slowest.
    """
    chosen: dict[int, list[int]] = {}
    for procedure in sorted({eq.runs[i].procedure for i in fitted}):
        mine = sorted((i for i in fitted if eq.runs[i].procedure == procedure), key=lambda i: eq.runs[i].turning)
        chosen |= dict.fromkeys((mine[0], mine[-1]), mine)
    stands_for: dict[Key, float] = {}
    for c in CHANNELS:
        for i, mine in chosen.items():
            if (i, c) in eq.rows:
                speakers = sum(1 for j in set(mine) & set(chosen) if (j, c) in eq.rows)
                like = sum(eq.rows[j, c].y.size for j in mine if (j, c) in eq.rows)
                stands_for[i, c] = like / (speakers * eq.rows[i, c].y.size)
    return replace(eq, noisy={i: eq.runs[i].noisier(i) for i in chosen}, stands_for=stands_for)
