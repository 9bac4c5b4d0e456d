"""What a form is made of: hats over a range, waves of an angle, what wears off with way or time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from rig.analysis.tracing.residual.past import LEAKS, WIDTHS, behind, relaxing, since_turned
from rig.analysis.tracing.residual.products import times
from rig.model.effect import Array, Signals
from rig.model.waves import powers

Factor = Callable[[Signals], Array]
"""Columns (n, k) of a piece of a run."""

WAYS: Final = (2.0, 6.0, 20.0, 60.0)  # rad of the motor since it turned back, within which all but a third is gone
TIMES: Final = (0.6, 1.5, 4.0, 10.0, 30.0)  # s since the run began, the same


def hats(x: Array, knots: Array) -> Array:
    """1 at one knot each and 0 at the others, straight between, (n, k); level beyond the last."""
    out = np.zeros((x.size, knots.size))
    if knots.size == 1:
        return out + 1.0
    x = np.clip(known(x), knots[0], knots[-1])
    left = np.clip(np.searchsorted(knots, x, "right") - 1, 0, knots.size - 2)
    share, row = (x - knots[left]) / (knots[left + 1] - knots[left]), np.arange(x.size)
    out[row, left], out[row, left + 1] = 1.0 - share, share
    return out


def known(x: Array) -> Array:
    """0 where it is not: of a few rows `nan_to_num` takes ten times as long."""
    return np.where(np.isfinite(x), x, 0.0)


def motor_waves(s: Signals, first: int, last: int, slopes: bool = False) -> Array:
    """Cosine and sine of orders `first` to `last` of the motor, as far as rows have kept them, or their slopes;
    (n, 2·orders)."""
    made = powers(s.theta_m, last, slopes=slopes)[:, 2 * (first - 1) :]
    if s.thinned == 1:
        return made
    kept = np.stack([s.kept(float(k), s.omega_m) for k in range(first, last + 1)], 1)
    return np.asarray(made * np.repeat(kept, 2, axis=1))


def load_waves(s: Signals, last: int) -> Array:
    """Cosine and sine of the orders of the output up to `last`, (n, 2·last)."""
    return powers(known(s.theta_l), last)


def turned(s: Signals, finer: int, also_at_first: bool) -> Array:
    """What wears off on the way since the motor turned back, (n, k); none before it first did, or `also_at_first` as if
    it had when the run began."""
    gone = _gone(since_turned(known(s.theta_m), s.way, np.zeros(s.t.size)), WAYS, finer)
    if also_at_first:
        return gone
    back = np.flatnonzero(np.diff(np.sign(s.way[s.way != 0])))
    first = np.flatnonzero(s.way != 0)[back[0] + 1] if back.size else s.t.size
    return np.asarray(gone * (np.arange(s.t.size) >= first)[:, None])


def turned_each_way(s: Signals, finer: int) -> Array:
    """The same of its turning forward and of its turning backward, (n, 2·k): what folds over folds one way."""
    return times(np.stack([s.way > 0, s.way < 0], 1).astype(float), turned(s, finer, False))


def began(s: Signals, finer: int) -> Array:
    """What wears off in the time since the run began, (n, k)."""
    return _gone(s.t - s.t[0], TIMES, finer)


def _gone(x: Array, reaches: tuple[float, ...], finer: int) -> Array:
    """exp(−x/reach) for each of them and, `finer`, as many again between, (n, k)."""
    between = np.exp(np.interp(np.arange(0, len(reaches) - 1 + 1e-9, 1 / finer), range(len(reaches)), np.log(reaches)))
    return np.asarray(np.exp(-x[:, None] / between))


def remembering(of: Callable[..., Array], *by: float) -> Factor:
    """`of` a piece, by those numbers, where each row depends on those before it: made of the whole run that the piece
    is cut from, and kept, for dozens of forms run along it at one place after the other."""

    def factor(s: Signals) -> Array:
        return s.lately(of.__name__, by, lambda: of(s, *by) if s.cut is None else s.cut.of(of(s.cut.whole, *by)))

    return factor


def past_torque(s: Signals) -> Array:
    """What the torque through the gear has been: plays and followers of it, N·m, (n, k)."""
    torque, run = known(s.torque), np.zeros(s.t.size)
    plays = [behind(torque, run, width) for width in WIDTHS]
    return np.stack([*plays, *(relaxing(torque, run, s.dt, leak) for leak in LEAKS)], 1)
