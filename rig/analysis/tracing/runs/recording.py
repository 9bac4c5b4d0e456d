"""A run as the tracer uses it: pieces on a uniform time grid, speeds and accelerations by one zero-phase filter."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from rig.analysis.tracing.runs.derived import derived
from rig.analysis.tracing.runs.look import Look
from rig.analysis.tracing.runs.smoothing import Smoother, flat
from rig.analysis.tracing.runs.stand_ins import in_stand_ins, reloaded, rewound, rubbing
from rig.core.once import Once
from rig.model.effect import MEASURED, Array, Known, Signals

MOVES = 0.05  # of its fastest, below which a run rests


@dataclass(frozen=True)
class Recording(Once):
    """One run. `pieces` hold no gap; `start` is s since the campaign began."""

    name: str
    procedure: str
    said: str  # procedure and conditions as declared
    locked: bool
    start: float
    ratio: float
    pieces: tuple[Signals, ...]
    smoother: Smoother
    has: frozenset[str]  # measured channels among theta_m, theta_l, tau_m, tau_l, t
    counts_m: float
    counts_l: float
    rate: float  # Hz of the file
    thinned: int  # rows of the file per row at the working rate
    noise: Mapping[str, float]  # RMS of white noise at the working rate, by channel
    notes: tuple[str, ...] = ()
    step_m: float = 0.0  # rad, the smallest change of the motor angle in the file; 0 where there is none
    step_l: float = 0.0  # the same of the load angle
    speed_rpm: float = 0.0  # as the conditions declare it, 0 where they do not
    declared: Mapping[str, float] = field(default_factory=dict)  # K, J_m, J_l as far as the manifest states them
    look: Look = field(default_factory=Look)  # what of it is looked at
    clocked: bool = False  # its seconds are those of the speed that it and others declare
    load_stated: bool = True  # whether the manifest says what hangs on the output
    load_known: bool = True  # but for friction; else the mean of its shaft torque is its own
    input_locked: bool = False  # `locked` is the motor, and the output is wound up
    added: float = 0.0  # kg·m² that hung on its load beside what all runs have (runs/added.py)

    @property
    def gear(self) -> Known:
        """What is known of the gear, and of the load that all runs have."""
        return self.laden(self.pieces[0].gear, -1.0)

    def laden(self, known: Known, times: float = 1.0) -> Known:
        """The same with what hung on the load in this run, so many times."""
        return replace(known, J_l=known.J_l + times * self.added) if self.added else known

    @property
    def knows(self) -> frozenset[str]:
        """Channels that are measured, or need not be: a locked output rests."""
        return self.has | {"theta_l"} if self.locked else self.has

    @property
    def is_wound(self) -> bool:
        """Whether the shaft torque is what the wind-up of a locked output says, for want of a sensor: of all rows of a
        piece or of none."""
        unread = self.locked and "tau_l" not in self.has
        return unread and any(bool(np.isfinite(piece.tau_l[0])) for piece in self.pieces)

    @property
    def load_unread(self) -> bool:
        """Whether its shaft torque is what the load takes, as far as that is known, and the motor's tells how much."""
        return "tau_l" not in self.has and not self.locked and {"theta_m", "tau_m"} <= self.has

    def wound(self, piece: Signals) -> Array:
        """The angle that goes when a piece is wound up, rad of the motor (n,): the motor's, or the load's the other way
        where it is the motor that is locked."""
        return -self.ratio * piece.theta_l if self.input_locked else piece.theta_m

    @property
    def carries(self) -> bool:
        """Whether effects found in the load are part of that."""
        return any(piece.carried is not None and bool(np.any(piece.carried)) for piece in self.pieces)

    @property
    def duration(self) -> float:
        """s of recorded motion."""
        return float(sum(piece.t.size * piece.dt for piece in self.pieces))

    @cached_property
    def turning(self) -> float:
        """Mean |speed| of the motor, rad/s."""
        return float(np.mean([np.mean(np.abs(piece.omega_m)) for piece in self.pieces]))

    def keeps_speed(self, within: float) -> bool:
        """Whether, while it moves, the speed of its fastest quarter is no more than `within` times its slowest's."""
        speed = np.concatenate([np.abs(piece.omega_m) for piece in self.pieces])
        moves = speed[speed >= MOVES * speed.max()]
        low, high = np.quantile(moves, (0.25, 0.75)) if moves.size else (0.0, 0.0)
        return bool(high <= within * low)

    @cached_property
    def mean_torque(self) -> float:
        """N·m through the gear, 0 where it is not known."""
        torque = np.concatenate([piece.torque for piece in self.pieces])
        return float(np.nanmean(torque)) if np.isfinite(torque).any() else 0.0

    def noisier(self, seed: int) -> Recording:
        """The same with its own sensor noise added once more: what noise does to columns is the difference."""
        rng = np.random.default_rng(seed)
        return replace(self, pieces=_each(self.pieces, lambda piece: _noisier(piece, self, rng)))

    def afresh(self) -> Recording:
        """The same with nothing made of its signals yet: what effects keep there goes when this copy does."""
        return replace(self, pieces=_each(self.pieces, replace))

    def knowing(self, known: Known) -> Recording:
        """The same with what is known of the gear. What is made of the run itself leans on that where a sensor is
        missing."""
        made = replace(self, pieces=_each(self.pieces, lambda piece: _knowing(piece, known, self)))
        return made.made_as(self) if self.knows >= MEASURED else made

    def carrying(self, taken: Callable[[Signals], Array | None]) -> Recording:
        """The same, and its load takes what `taken` makes of each piece, N·m (n,), of a torque that nobody read."""
        timed = "t" in self.has
        return replace(self, pieces=_each(self.pieces, lambda piece: reloaded(piece, piece.gear, taken(piece), timed)))


def read_by_any(runs: Sequence[Recording]) -> frozenset[str]:
    """Channels that at least one of them read."""
    return frozenset().union(*(run.has for run in runs))


def mean_speed(run: Recording) -> float:
    """Of the motor over the whole run, rad/s: of a run that goes as far forth as back, zero."""
    return float(np.mean(np.concatenate([piece.omega_m for piece in run.pieces])))


def mean_way(run: Recording) -> float:
    """1 or −1 of a motor that turned one way all the time, 0 of one that went as far forth as back."""
    return float(np.mean(np.concatenate([piece.way for piece in run.pieces])))


def _each(pieces: Sequence[Signals], change: Callable[[Signals], Signals]) -> tuple[Signals, ...]:
    """Every piece changed; of parts, what they were cut from."""
    wholes: dict[int, Signals] = {}
    out = []
    for piece in pieces:
        whole = piece if piece.cut is None else piece.cut.whole
        if id(whole) not in wholes:
            wholes[id(whole)] = change(whole)
        made = wholes[id(whole)]
        out.append(made if piece.cut is None else piece.cut.again(made))
    return tuple(out)


def _knowing(piece: Signals, known: Known, run: Recording) -> Signals:
    known = run.laden(known)
    if run.is_wound:
        return rewound(piece, known)
    if run.look.inertia and known.J_l != piece.gear.J_l:
        return reloaded(piece, known, piece.carried, "t" in run.has)
    torque = piece.torque + piece.gear.torque_zero - known.torque_zero
    if run.load_unread:
        torque = torque + rubbing(piece, known) - rubbing(piece, piece.gear)
    return replace(piece, gear=known, torque=torque)


def _noisier(piece: Signals, run: Recording, rng: np.random.Generator) -> Signals:
    dt = run.smoother.dt
    added = {n: s * rng.standard_normal(piece.t.size) for n, s in run.noise.items() if hasattr(piece, n)}
    added |= in_stand_ins(added, piece, dt, run.locked, "t" in run.has)
    c = {n: getattr(piece, n) + added.get(n, 0.0) for n in ("theta_m", "theta_l", "tau_m", "tau_l")}
    return replace(
        piece,
        **{**c, **derived(c, run.smoother), "torque": piece.torque + flat(added.get("tau_l", np.zeros(piece.t.size)))},
    )
