"""More arrays for the page of a trace: where the rest lives, close-ups of held-out runs, intervals of the errors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import WHOLE
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.outcome.errors import UNITS
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.residual.bins import BINNED, FEWEST, rms
from rig.analysis.tracing.residual.joined import rest
from rig.analysis.tracing.residual.lines import spectrum
from rig.analysis.tracing.residual.shares import shares
from rig.analysis.tracing.runs.strokes import strokes
from rig.core.units import TURN
from rig.model.effect import Array

SHOWN_TURNS: Final = 2.0  # of a close-up: one turn, and that it repeats
DRAWS: Final = 1000  # of the bootstrap: its 2.5 % points then stand on 25 draws
QUARTERS: Final = 4  # of a run: what is drawn again and again, many correlation times long
ORDERS: Final = np.arange(0.02, 40.0, 0.02)  # of the motor: beyond the series, steps of one output turn
EXCESS: Final = 0.21  # of the squared floor (a ratio of 1.1): below it there is nothing to share out


def pictures(p: Prepared, before: Mapping[Key, Array], after: Mapping[Key, Array]) -> dict[str, Array]:
    """Curves by dotted name, of held-out residuals `before` and `after` (bare, SI). `<C>` is A (θ̃), M (τ_m) or L (τ_l).

    where.<C>.<coordinate>.x, .before, .after (b,)
        RMS over floor in bins of a coordinate; x in ° for angles, ±1, N·m, rpm, s
    share.<C> (11,)
        share of the excess before that each of `shares.COORDINATES`, then of `PAIRS`, predicts in rows it was not
        fitted to, 0 to 1; absent where there is no excess, NaN for the load in L, whose reading is itself the load
    share_frequency_hz.<C> (2,)
        a fixed frequency that runs of differing speed have in common, and its share; absent where there is none
    close.<run>.<C>.turns, .measured, .before, .after (n,)
        two motor turns of a run that turns, arcsec or N·m, each less its mean over the run
    orders.motor_order, orders.<C>.before, .after (n,)
        amplitude of the residual of M and L by order of the motor, N·m; those of A are in `spectrum`
    turn.load_deg, .before_arcsec, .after_arcsec (N,)
        mean residual of θ̃ over whole motor turns of the output's turn: the motor's own orders average out
    run_at.<run> (2,)      motor speed in rpm and external torque in N·m
    interval.<C>.before, .after (2,)
        95 % of the RMS over all held-out runs, arcsec or N·m: quarters of runs drawn again with replacement
    """
    out: dict[str, Array] = {}
    for channel in WHOLE:
        keys = [key for key in before if key[1] == channel]
        if not keys:
            continue
        out |= where(p, before, after, channel)
        for name, e in (("before", before), ("after", after)):
            out[f"interval.{channel}.{name}"] = interval([e[key] for key in keys]) * UNITS[channel]
        for key in keys:
            out |= close_up(p, key, before[key], after[key])
    out |= by_turn(p, before, after) | by_order(p, before, after)
    for i in p.held_out.runs:
        run = p.eq.runs[i]
        speed = float(np.mean([q.omega_m.mean() for q in run.pieces])) * 60 / TURN
        turning = float(np.mean([np.abs(q.omega_m).mean() for q in run.pieces])) * 60 / TURN
        out[f"run_at.{run.name}"] = np.array(
            [speed if abs(speed) > 0.5 * turning else turning, -run.pieces[0].tau_ext[0]]
        )
    return out


def where(p: Prepared, before: Mapping[Key, Array], after: Mapping[Key, Array], channel: str) -> dict[str, Array]:
    """`where.*` and `share.*` of one channel."""
    first, last = (rest(p.eq, e, p.held_out.floors, channel, beside=False) for e in (before, after))
    out: dict[str, Array] = {}
    if first is None or last is None:
        return out
    for name, binned in BINNED.items():
        x = binned(first)
        if x is None:
            continue
        index, middles = x
        stem = f"where.{channel}.{name}"
        out[f"{stem}.x"] = middles
        out[f"{stem}.before"], out[f"{stem}.after"] = (rms(e, index, middles.size) for e in (first.e, last.e))
    if np.mean(first.e**2) > 1 + EXCESS and (whole := rest(p.eq, before, p.held_out.floors, channel)) is not None:
        out |= shares(whole, channel)
    return out


def by_order(p: Prepared, before: Mapping[Key, Array], after: Mapping[Key, Array]) -> dict[str, Array]:
    """`orders.*` of the torque channels."""
    out: dict[str, Array] = {}
    for channel in ("M", "L"):
        for name, e in (("before", before), ("after", after)):
            r = rest(p.eq, e, dict.fromkeys(p.held_out.floors, 1.0), channel, beside=False)
            if r is not None and np.isfinite(r.at["motor_angle"]).all():
                out["orders.motor_order"] = ORDERS
                out[f"orders.{channel}.{name}"] = 2 * np.sqrt(spectrum(r.at["motor_angle"], r.e, ORDERS)) / r.e.size
    return out


def by_turn(p: Prepared, before: Mapping[Key, Array], after: Mapping[Key, Array]) -> dict[str, Array]:
    """`turn.*`; {} where there is no load angle."""
    keys, bins = [k for k in before if k[1] == "A"], round(p.eq.runs[0].ratio)
    shown = rest(p.eq, {k: before[k] for k in keys}, dict.fromkeys(keys, 1.0), "A", beside=False)
    if shown is None or not np.isfinite(shown.at["load_angle"]).all():
        return {}
    index = (np.mod(shown.at["load_angle"], TURN) / TURN * bins).astype(np.int64) % bins
    count = np.bincount(index, minlength=bins)
    out = {"turn.load_deg": (np.arange(bins) + 0.5) * 360 / bins}
    for name, e in (("before", before), ("after", after)):
        total = np.bincount(index, np.concatenate([e[k] for k in keys]), minlength=bins)
        out[f"turn.{name}_arcsec"] = np.where(count >= FEWEST, total / np.maximum(count, 1), np.nan) * UNITS["A"]
    return out


def close_up(p: Prepared, key: Key, before: Array, after: Array) -> dict[str, Array]:
    """Two turns from the middle of the longest stroke of a run; {} when it does not turn as far."""
    run, rows = p.eq.runs[key[0]], p.eq.rows[key]
    stroke = max(strokes(rows.theta_m), key=lambda s: s.stop - s.start, default=slice(0, 0))
    turns = rows.theta_m[stroke] / TURN
    if turns.size < 2 or np.ptp(turns) < SHOWN_TURNS:
        return {}
    start = np.floor((turns.min() + turns.max() - SHOWN_TURNS) / 2)  # at a whole turn: order 2 is then seen to repeat
    shown = (turns >= start) & (turns <= start + SHOWN_TURNS)
    unit = UNITS[key[1]]
    measured = rows.y - rows.y.mean()
    values = {"measured": measured, "before": measured - before, "after": measured - after}
    stem = f"close.{run.name}.{key[1]}"
    out = {f"{stem}.{name}": (v[stroke][shown]) * unit for name, v in values.items()}
    return out | {f"{stem}.turns": turns[shown] - start}


def interval(e: list[Array]) -> Array:
    """95 % interval (2,) of the RMS of all rows: the percentile bootstrap over quarters of runs, seed fixed."""
    parts = [q for x in e for q in np.array_split(x, QUARTERS)]
    squares, rows = np.array([q @ q for q in parts]), np.array([q.size for q in parts])
    drawn = np.random.default_rng(1).integers(0, len(parts), (DRAWS, len(parts)))
    return np.asarray(np.quantile(np.sqrt(squares[drawn].sum(1) / rows[drawn].sum(1)), [0.025, 0.975]))
