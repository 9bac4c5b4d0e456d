"""Order-resolved ripple of a torque over runs: what of it is constant, grows with load or speed, comes late, drifts.

What one angle and one torque can say without the rest. Of order k in a run at speed ω and mean torque T:

    ripple = Re[(c_0 + c_T·|T| + c_ω·ω²)·exp(jk(θ_m − ω·δ))]

δ is how late the torque is read against the angle, the same for all orders; in a gear near its resonance the phase
turns with speed by itself, and δ holds well below it only. Where no row has a time ω is what the conditions declare.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.collected import true_minus
from rig.analysis.tracing.fit.channels import SENSOR_NAMES
from rig.analysis.tracing.runs.recording import Recording, read_by_any
from rig.core.quantiles import Z95
from rig.core.units import RPM
from rig.model.effect import MEASURED, Array, Signals

Complex = npt.NDArray[np.complex128]
KEYS: Final = {"constant": "constant_Nm", "per_load": "per_load", "per_speed_squared": "per_speed_squared"}
HIGHEST: Final = 24  # order
ROWS: Final = 3.0  # a period of an order, at least: the thinned rows hold no more
PART: Final = 1 / 6  # of an output turn: less of it looks like a trend
TOLD: Final = 4  # strongest orders
TURNS: Final = 3.0  # of the motor in a run: fewer do not tell an order from its neighbours
LATEST: Final = 5e-3  # s
CLEAR: Final = 3.0  # standard errors
DAY: Final = 86400.0  # s
SPEEDS: Final = 3  # runs of differing speed before a law of it is asked for
UNLIKE: Final = 1.3  # highest over lowest of speeds or loads: else they are one
FLOOR: Final = 2.0  # N·m that a load must differ by at least


@dataclass(frozen=True)
class Seen:
    """One run: mean speed rad/s, 0 where it is not known, mean |torque| N·m, start s, phasors (HIGHEST,) N·m, their
    standard error; phasors are NaN of orders that have too few rows a period."""

    speed: float
    load: float
    start: float
    phasors: Complex
    error: float


@dataclass(frozen=True)
class Ripple:
    """One order in all runs: amplitudes in N·m, N·m per N·m, N·m per (rad/s)², None where the runs cannot say; lag in s
    and relative change per day. `halves` are halves of the 95 % intervals of those amplitudes, by their names, the
    others have theirs with them."""

    channel: str
    order: int
    runs: int
    constant: float
    per_load: float | None
    per_speed_squared: float | None
    lag: tuple[float, float] | None
    per_day: tuple[float, float] | None
    halves: Mapping[str, float]

    def document(self) -> dict[str, Any]:
        """For trace.json."""
        return {
            "channel": self.channel, "order": self.order, "runs": self.runs, "constant_Nm": self.constant,
            "per_load": self.per_load, "per_speed_squared": self.per_speed_squared,
            "half95": {key: self.halves.get(name) for name, key in KEYS.items()},
            "lag_s": None if self.lag is None else {"value": self.lag[0], "half95": self.lag[1]},
            "change_per_day": None if self.per_day is None else {"value": self.per_day[0], "half95": self.per_day[1]},
        }  # fmt: skip

    def sentence(self) -> str:
        """For people."""
        name = SENSOR_NAMES[self.channel]
        runs = f"{self.runs} run{'' if self.runs == 1 else 's'}"
        said = [f"Ripple of the {name} at order {self.order} of the motor, {runs}: {self._pm('constant', 1.0)} N·m"]
        if self.per_load is not None:
            said.append(f"{self._pm('per_load', 1e3)} mN·m more per N·m of load")
        if self.per_speed_squared is not None:
            said.append(f"{self._pm('per_speed_squared', 1e3)} mN·m more per (rad/s)²")
        if self.lag is not None:
            late = f"{1e3 * self.lag[0]:.3g} ± {1e3 * self.lag[1]:.2g} ms after the angle"
            said.append(f"read {late} (or turned so by a resonance)")
        if self.per_day is not None:
            said.append(f"changing by {100 * self.per_day[0]:.2g} ± {100 * self.per_day[1]:.2g} % a day")
        return true_minus(", ".join(said) + ".")

    def _pm(self, name: str, scale: float) -> str:
        return f"{scale * getattr(self, name):.3g} ± {scale * self.halves[name]:.2g}"


def ripples(runs: Sequence[Recording]) -> tuple[Ripple, ...]:
    """Of every torque that was measured, where a channel is missing; () where none is, for then A, M and L say more."""
    has = read_by_any(runs)
    if has >= MEASURED:
        return ()
    found: list[Ripple] = []
    for channel in ("tau_l", "tau_m"):
        seen = [s for run in runs if (s := of_run(run, channel)) is not None] if channel in has else []
        if seen:
            found += _laws(channel, seen, all(s.speed for s in seen))
    return tuple(found)


def of_run(run: Recording, channel: str) -> Seen | None:
    """Phasors of the orders in one run that turns one way; None where it turns too little."""
    piece = max(run.pieces, key=lambda p: p.t.size)
    moving = np.abs(piece.way.sum()) > 0.9 * piece.t.size
    turns = np.ptp(piece.theta_m) / (2 * np.pi)
    torque = getattr(piece, channel)
    if channel not in run.has or run.locked or not moving or turns < TURNS or not np.isfinite(torque).all():
        return None
    x = piece.theta_m - piece.theta_m.mean()
    shown = min(HIGHEST, int(x.size / turns / ROWS))
    if shown < 1:
        return None
    angles = np.multiply.outer(piece.theta_m, np.arange(1, shown + 1))
    slow = _slow(piece.theta_m / run.ratio, x / np.ptp(x))
    z = np.hstack([slow, np.cos(angles), np.sin(angles)])
    c = np.linalg.lstsq(z, torque, rcond=None)[0]
    left = torque - z @ c
    # rows a tenth of a turn apart are taken as independent
    independent = max(10.0 * turns, 1.0)
    phasors = np.full(HIGHEST, np.nan, dtype=np.complex128)
    phasors[:shown] = c[slow.shape[1] :][:shown] - 1j * c[slow.shape[1] :][shown:]
    error = float(np.std(left) * np.sqrt(2.0 / independent))
    return Seen(_speed(run, piece), float(abs(torque.mean())), run.start, phasors, error)


def _speed(run: Recording, piece: Signals) -> float:
    """Of the motor, rad/s: as measured, as declared where there is no time, 0 where nobody says it."""
    if "t" in run.has:
        return float(piece.omega_m.mean())
    return float(np.copysign(run.speed_rpm * RPM, piece.way.sum()))


def _slow(output: Array, along: Array) -> Array:
    """What no order of the motor makes (n, c): a constant and a trend, and over a good part of an output turn the once
    and twice of it that weight makes. `output` rad, `along` the run."""
    columns = [np.ones(along.size), along]
    if np.ptp(output) > PART * 2 * np.pi:
        columns += [wave(k * output) for k in (1, 2) for wave in (np.cos, np.sin)]
    return np.stack(columns, 1)


def _laws(channel: str, seen: Sequence[Seen], timed: bool) -> list[Ripple]:
    phasors = np.array([s.phasors for s in seen])
    weight = 1.0 / np.array([max(s.error, 1e-12) for s in seen])
    seen_in = np.isfinite(phasors).sum(0)
    strength = np.sqrt(np.nansum(np.abs(phasors) ** 2, axis=0) / np.maximum(seen_in, 1))
    clear = strength > CLEAR * float(np.sqrt(np.mean([s.error**2 for s in seen])))
    best = [int(k) for k in np.argsort(-strength) if clear[k]][:TOLD]
    lag = _lag(seen, phasors, weight, best) if timed and best and _various([s.speed for s in seen]) else None
    return [_law(channel, k, seen, phasors[:, k], weight, lag, timed) for k in sorted(best)]


def _various(speeds: Sequence[float]) -> bool:
    """Whether there are enough differing speeds; both ways count as two."""
    distinct = sorted(speeds)
    gaps = sum(abs(b - a) > (UNLIKE - 1) * max(abs(a), abs(b)) for a, b in itertools.pairwise(distinct))
    return gaps + 1 >= SPEEDS


def _columns(seen: Sequence[Seen], timed: bool) -> tuple[Array, list[str]]:
    """Columns of the law (runs, c) that the runs can tell apart, and their names."""
    load, speed = np.array([s.load for s in seen]), np.array([s.speed for s in seen])
    columns, names = [np.ones(len(seen))], ["constant"]
    if np.ptp(load) > FLOOR and load.max() > UNLIKE * load.min() and len(seen) > len(names) + 1:
        columns.append(load)
        names.append("per_load")
    if timed and _various(list(speed)) and len(seen) > len(names) + 1:
        columns.append(speed**2)
        names.append("per_speed_squared")
    return np.stack(columns, 1), names


def _missed(z: Array, phasors: Complex, weight: Array, turned: Complex) -> tuple[float, Complex]:
    """Weighted sum of squares and coefficients of one order when its phase turns as `turned` (runs,)."""
    there = np.isfinite(phasors)
    design, y = (z * turned[:, None] * weight[:, None])[there], (phasors * weight)[there]
    c = np.linalg.lstsq(design, y, rcond=None)[0]
    return float(np.sum(np.abs(y - design @ c) ** 2)), np.asarray(c, dtype=np.complex128)


def _lag(seen: Sequence[Seen], phasors: Complex, weight: Array, orders: Sequence[int]) -> tuple[float, float] | None:
    """δ that all strong orders share, and half its interval from the curvature and the scatter that is left; None where
    no δ within LATEST is better than those beside it, or the interval is wider than that."""
    z, _ = _columns(seen, True)
    speed = np.array([s.speed for s in seen])
    grid = np.linspace(-LATEST, LATEST, 2001)
    total = np.array(
        [sum(_missed(z, phasors[:, k], weight, np.exp(-1j * (k + 1) * speed * d))[0] for k in orders) for d in grid]
    )
    at = int(np.argmin(total))
    if not 0 < at < grid.size - 1:
        return None
    bend = (total[at - 1] - 2 * total[at] + total[at + 1]) / (grid[1] - grid[0]) ** 2
    if bend <= 0:
        return None
    freedom = max(1, 2 * len(orders) * (len(seen) - z.shape[1]) - 1)
    scatter = max(1.0, total[at] / freedom)
    shift = 0.5 * (total[at + 1] - total[at - 1]) / (bend * (grid[1] - grid[0]))
    half = float(Z95 * np.sqrt(2 * scatter / bend))
    return (float(grid[at] - shift), half) if half < LATEST else None


def _law(
    channel: str, k: int, seen: Sequence[Seen], phasors: Complex, weight: Array, lag: tuple[float, float] | None,
    timed: bool,
) -> Ripple:  # fmt: skip
    there = np.isfinite(phasors)
    seen, phasors, weight = [s for s, ok in zip(seen, there, strict=True) if ok], phasors[there], weight[there]
    z, names = _columns(seen, timed)
    speed = np.array([s.speed for s in seen])
    turned = np.exp(-1j * (k + 1) * speed * (lag[0] if lag else 0.0))
    total, c = _missed(z, phasors, weight, turned)
    made = dict(zip(names, map(float, np.abs(c)), strict=True))
    return Ripple(
        channel, k + 1, len(seen), made["constant"], made.get("per_load"), made.get("per_speed_squared"), lag,
        _drift(seen, phasors, z @ c * turned), dict(zip(names, _halves(z * weight[:, None], total), strict=True)),
    )  # fmt: skip


def _halves(design: Array, total: float) -> list[float]:
    """Halves of the 95 % intervals of amplitudes, from the weighted columns (runs, c) and the sum of squares that is
    left; of as many runs as columns from what each run by itself leaves."""
    freedom = 2 * (design.shape[0] - design.shape[1])
    scatter = max(1.0, total / freedom) if freedom else 1.0
    known = np.linalg.pinv(design.T @ design)
    return [float(Z95 * np.sqrt(scatter * x)) for x in np.diag(known)]


def _drift(seen: Sequence[Seen], phasors: Complex, law: Complex) -> tuple[float, float] | None:
    """Relative change of the amplitude per day beside the law; None for runs of one day."""
    days = np.array([s.start for s in seen]) / DAY
    if np.ptp(days) < 1.0 or len(seen) < SPEEDS:
        return None
    gain = np.real(phasors * np.conj(law)) / np.maximum(np.abs(law) ** 2, 1e-300)
    z = np.stack([np.ones(days.size), days - days.mean()], 1)
    c, *_ = np.linalg.lstsq(z, gain, rcond=None)
    left = gain - z @ c
    error = np.sqrt(float(left @ left) / max(1, days.size - 2) / float(z[:, 1] @ z[:, 1]))
    return float(c[1]), float(Z95 * error)
