"""A run as the tracer uses it: pieces on a uniform time grid, speeds and accelerations by one zero-phase filter."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from rig.analysis.motion.smallest_step import smallest_step
from rig.analysis.motion.source import Motion, Source, motion_of
from rig.analysis.motion.tame import Tame
from rig.analysis.tracing.runs.clocked import is_clocked, slowed
from rig.analysis.tracing.runs.declared import believed, is_locked, locked_all_the_same, stated, states
from rig.analysis.tracing.runs.grid import grid, is_even, joined, refuse_other_time, refuse_sparse, uniform
from rig.analysis.tracing.runs.holes import without_holes
from rig.analysis.tracing.runs.input_locked import is_input_locked
from rig.analysis.tracing.runs.late import earlier
from rig.analysis.tracing.runs.look import FIRST, Look
from rig.analysis.tracing.runs.meanings import computed_torque
from rig.analysis.tracing.runs.resolution import noise_of, quiet
from rig.analysis.tracing.runs.sliding import direction
from rig.analysis.tracing.runs.smoothing import Smoother, flat, flat_rate, thin
from rig.analysis.tracing.runs.stamped import evened
from rig.analysis.tracing.runs.stand_ins import in_stand_ins, reloaded, rewound, rubbing, substituted
from rig.analysis.tracing.thresholds import BANDWIDTH, FASTER, RATE
from rig.core.drivetrain import RATIOS
from rig.core.errors import UsageError
from rig.core.once import Once
from rig.model.effect import MEASURED, Array, Known, Signals
from rig.runfile.run import Run

MOVES = 0.05  # of its fastest, below which a run rests
TAMEST = 1 / 7  # of the sample rate: the widest low-pass whose second derivative is free of aliases


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


def mean_way(run: Recording) -> float:
    """1 or −1 of a motor that turned one way all the time, 0 of one that went as far forth as back."""
    return float(np.mean(np.concatenate([piece.way for piece in run.pieces])))


def record(whole_run: Run, start: float, hz: float | None = None, look: Look = FIRST) -> Recording:
    """Read the columns the tracer uses; what is absurd counts as missing. Rows of a run without a time that declares
    its speed come `hz` times a second, where that is known. A fast `look` takes more of them. Raises UsageError when
    the run has no angle it can use, rows too far apart or too close, or a ratio no gear has.
    """
    run = Tame(whole_run)
    _refuse_ratio(run.ratio)
    motion = motion_of(run)
    refuse_other_time(run.column("t"), motion)
    channels, breaks, holes = without_holes(_channels(run, motion), motion.breaks if motion else ())
    clocked = is_clocked(run)
    if hz is not None and clocked:
        channels["t"] = np.arange(next(x.size for x in channels.values() if x is not None)) / hz
    has = frozenset(name for name, values in channels.items() if values is not None)
    rows = next((x.size for x in channels.values() if x is not None), whole_run.rows)
    t, dt, steady = grid(channels["t"], rows, run)
    refuse_sparse(rows, dt)
    t, stamps = evened(t, channels["theta_m"] if channels["theta_m"] is not None else channels["theta_l"], dt)
    dt = float(np.median(np.diff(t))) if stamps else dt
    whole = {name: np.full(rows, np.nan) if c is None else c for name, c in channels.items() if name != "t"}
    uneven = None if is_even(t, dt) else t
    held = is_input_locked(channels, run.ratio)
    encoders = run.manifest.get("encoders") or {}
    factor, smoother = _smoothing(channels["theta_m"], dt, encoders, look)
    tau_ext = stated(run.conditions, "tau_ext", 0.0)
    whole = {name: _forward(name, x, look, dt) for name, x in whole.items()}
    made = [
        _piece(t[lo:hi], {n: c[lo:hi] for n, c in whole.items()}, dt, factor, smoother, run, start, tau_ext, "t" in has)
        for lo, hi in joined(t, whole["theta_m"], dt, breaks, steady)
    ]
    if hz is not None and "t" not in has and run.procedure == "kinematic_error":
        made = [piece if piece is None else slowed(piece) for piece in made]
    return Recording(
        name=run.name,
        procedure=run.procedure,
        said=f"{run.procedure} {sorted((k, v) for k, v in run.conditions.items() if k != 'note')}",
        locked=is_locked(run) or held,
        start=start,
        ratio=run.ratio,
        pieces=tuple(piece for piece in made if piece is not None),
        smoother=smoother,
        has=has,
        counts_m=float(encoders.get("motor_counts_per_rev") or 0.0),
        counts_l=float(encoders.get("load_counts_per_rev") or 0.0),
        rate=1 / dt,
        thinned=factor,
        noise={n: noise_of(n, c, encoders, uneven) / float(np.sqrt(factor)) for n, c in whole.items() if n in has},
        notes=(
            *run.notes,
            *(() if held else locked_all_the_same(run)),
            *_noted(motion, holes, stamps),
            *computed_torque(whole_run),
        ),
        input_locked=held,
        step_m=0.0 if channels["theta_m"] is None else smallest_step(channels["theta_m"]),
        step_l=0.0 if channels["theta_l"] is None else smallest_step(channels["theta_l"]),
        speed_rpm=abs(stated(run.conditions, "speed_rpm", 0.0)),
        load_stated=states(run.conditions, "tau_ext"),
        clocked=hz is not None and clocked,
        declared={n: abs(s) for n in ("K", "J_m", "J_l") if (s := stated(run.declared, n, 0.0))},
        look=look,
    )


def _smoothing(theta_m: Array | None, dt: float, encoders: Mapping[str, float], look: Look) -> tuple[int, Smoother]:
    """One of how many rows, `dt` apart, is worked with, and the low-pass: twice as many and as wide as usual where a
    `look` is fast, and narrower where it says so or the motor's encoder is coarse."""
    often, narrow = FASTER if look.fast else 1.0, look.narrow or np.inf
    factor = max(1, round(1 / dt / (often * RATE)))
    work = dt * factor
    sigma, of_the_motor = (
        min(TAMEST / work, narrow, quiet(theta_m, encoders, width)) for width in (often * BANDWIDTH, BANDWIDTH)
    )
    return factor, Smoother(sigma, work, 2 if 1 / work > 3 * sigma else 1, of_the_motor)


def _noted(motion: Motion | None, *said: str) -> list[str]:
    """What was noted of a run's motion, and what is `said` of rows that are missing and of its time, if anything."""
    return [*(motion.notes if motion else ()), *filter(None, said)]


def _channels(run: Source, motion: Motion | None) -> dict[str, Array | None]:
    names = ("tau_m", "tau_l", "temperature")
    if motion is None:
        found = {name: _there(run.column(name)) for name in (*names, "theta_l")}
        return {"t": run.column("t"), "theta_m": None, **found}
    picked = {name: _there(motion.pick(run.column(name))) for name in names}
    return {"t": motion.t, "theta_m": motion.theta_m, "theta_l": motion.theta_l, **picked}


def _forward(name: str, x: Array, look: Look, dt: float) -> Array:
    """A column as it is looked at, its rows `dt` apart."""
    late = {"tau_l": look.late_torque, "theta_l": look.late_load}.get(name, 0.0)
    return earlier(x, late / dt) if late else x


def _there(x: Array | None) -> Array | None:
    """A column of which most is numbers; one of mostly holes is no measurement."""
    return x if x is not None and float(np.mean(np.isfinite(x))) > 0.5 else None


def _refuse_ratio(ratio: float) -> None:
    if not RATIOS[0] <= ratio <= RATIOS[1]:
        raise UsageError(f"gear.ratio is {ratio:g}, expected {RATIOS[0]:g} to {RATIOS[1]:g}")


def _piece(
    t: Array,
    c: dict[str, Array],
    dt: float,
    factor: int,
    smooth: Smoother,
    run: Source,
    start: float,
    tau_ext: float,
    timed: bool,
) -> Signals | None:
    """One piece at the working rate."""
    c = {name: uniform(t, x, dt) for name, x in c.items()}
    first = t[0]
    if factor > 1:
        thinned = {name: thin(x, factor) for name, x in c.items()}
        first += thinned["theta_m"][1] * dt
        c = {name: x for name, (x, _) in thinned.items()}
    n = c["theta_m"].size
    if n < 10 * smooth.half:
        return None
    c = substituted(c, smooth.dt, run, tau_ext, timed)
    time = start + first + smooth.dt * np.arange(n)
    derived = _derived(c, smooth)
    return Signals(
        t=time,
        dt=smooth.dt,
        ratio=run.ratio,
        theta_m=c["theta_m"],
        theta_l=c["theta_l"],
        tau_m=c["tau_m"],
        tau_l=c["tau_l"],
        tau_ext=np.full(n, tau_ext),
        way=direction(smooth.same(c["theta_m"], 1), smooth.dt),
        temperature=c["temperature"],
        gear=believed(run),
        thinned=factor,
        past=(),
        cut=None,
        **derived,
    )


def _derived(c: Mapping[str, Array], smooth: Smoother) -> dict[str, Array]:
    """Speeds, accelerations and the smooth torque from readings at the working rate."""
    dt = smooth.dt
    return {
        "omega_m": flat_rate(c["theta_m"], dt, 1),
        "alpha_m": flat_rate(c["theta_m"], dt, 2),
        "omega_l": flat_rate(c["theta_l"], dt, 1),
        "alpha_l": flat_rate(c["theta_l"], dt, 2),
        "torque": flat(c["tau_l"]),
        "torque_rate": flat_rate(c["tau_l"], dt, 1),
    }


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
    derived = _derived(c, run.smoother)
    return replace(piece, **{**c, **derived, "torque": piece.torque + flat(added.get("tau_l", np.zeros(piece.t.size)))})
