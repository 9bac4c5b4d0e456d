"""Free simulation of the model before and after on held-out runs, beside what was measured."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.led import Model, model_of, rung
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.outcome.replay import GONE, replayed, shown
from rig.analysis.tracing.outcome.result import Before
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.runs.recording import Recording
from rig.core.units import ARCSEC, TURN
from rig.model.effect import Array

CLOSE_UP: Final = 2.0  # motor turns
BACK: Final = 0.01  # motor turns: more than jitter
FEWEST: Final = 200  # rows after the start is forgotten


@dataclass(frozen=True)
class Free:
    """One run: motor angle (n,) rad, kinematic error measured and simulated (n,) arcsec, each less its mean; RMS before
    and after, arcsec, of what the rest of the shaft torque's equation makes by itself, None where there is none."""

    theta_m: Array
    measured: Array
    before: Array
    after: Array
    by_load: tuple[float | None, float | None] = (None, None)

    @property
    def errors(self) -> tuple[float, float]:
        """RMS of simulated less measured, before and after, arcsec."""
        left = (self.before - self.measured, self.after - self.measured)
        return float(np.std(left[0])), float(np.std(left[1]))


def free(
    p: Prepared, before: Solution, after: Solution, left: tuple[Mapping[Key, Array], Mapping[Key, Array]] = ({}, {})
) -> dict[str, Free]:
    """Of the fastest held-out run, where the gear's own dynamics are most of it, and the most loaded one, by name; {}
    where no held-out run turns freely with both angles, or motion and effects do not settle. `left` are the held-out
    residuals of the equations before and after."""
    models = model_of(before), model_of(after)
    out: dict[str, Free] = {}
    for key in _chosen(p):
        found = _simulated(p, key, models, left)
        if found is not None:
            out[p.eq.runs[key[0]].name] = found
    return out


def _chosen(p: Prepared) -> list[Key]:
    runs = p.eq.runs
    able = [k for k in ((i, "A") for i in p.held_out.runs) if k in p.eq.rows and not runs[k[0]].locked]
    able = [k for k in able if {"t", "theta_l"} <= runs[k[0]].has]
    fastest = max(able, key=lambda k: runs[k[0]].turning, default=None)
    loaded = max(able, key=lambda k: abs(float(runs[k[0]].pieces[0].tau_ext[0])), default=None)
    return list(dict.fromkeys(k for k in (fastest, loaded) if k is not None))


def _simulated(
    p: Prepared, key: Key, models: tuple[Model, Model], left: tuple[Mapping[Key, Array], Mapping[Key, Array]] = ({}, {})
) -> Free | None:
    run, rows = p.eq.runs[key[0]], p.eq.rows[key]
    made = [replayed(run, model) for model in models]
    if any(m is None for m in made):
        return None
    count = run.smoother.rows(shown(run).t.size)
    keep = rows.keep[:count].copy()
    keep[: round(GONE * models[1].decay / (run.smoother.dt * run.smoother.step))] = False
    if keep.sum() < FEWEST:
        return None
    here = keep[rows.keep.nonzero()[0][rows.keep.nonzero()[0] < count]]  # of the rows that are compared at all
    measured, theta = rows.y[: here.size][here], rows.theta_m[: here.size][here]
    columns = [m[keep] for m in made if m is not None]
    before, after, seen = (_own_out(p, key, x, here) / ARCSEC for x in (*columns, measured))
    by_load = _by_load(p, key, left[0], models[0], keep), _by_load(p, key, left[1], models[1], keep)
    return Free(theta, seen, before, after + _vibration(p, run, keep, seen - after), by_load)


def _by_load(p: Prepared, key: Key, left: Mapping[Key, Array], model: Model, keep: Array) -> float | None:
    """RMS in arcsec, over the rows `keep`, of what the rest of the load's equation makes of θ̃: torque that shakes the
    load and that the simulation, unlike the equations, reads nowhere. None where the shaft torque is not measured."""
    of_load = (key[0], "L")
    if of_load not in left:
        return None
    smoother, there = p.eq.runs[key[0]].smoother, p.eq.rows[of_load].keep
    torque = np.zeros(there.size)
    torque[there] = left[of_load]
    laden = replace(model, gear=p.eq.runs[key[0]].laden(model.gear))
    made = rung(torque[: keep.size], smoother.dt * smoother.step, laden)
    return float(np.std(made[keep])) / ARCSEC


def _vibration(p: Prepared, run: Recording, keep: Array, left: Array) -> Array:
    """What a named vibration makes of `left` (n,), in the phase this run has; zero where none is named."""
    named = p.own.parameters.get("external_vibration")
    if named is None:
        return np.zeros(left.size)
    x = 2 * np.pi * named[0].value * np.arange(keep.size)[keep] * run.smoother.dt * run.smoother.step
    z = np.stack([np.cos(x), np.sin(x)], 1)
    return np.asarray(z @ np.linalg.lstsq(z, left, rcond=None)[0])


def _own_out(p: Prepared, key: Key, x: Array, here: Array) -> Array:
    """Less its mean, and without the steps that the run has to itself."""
    own = p.eq.own.get(key)
    z = np.ones((x.size, 1)) if own is None else np.hstack([np.ones((x.size, 1)), own[: here.size][here]])
    return np.asarray(x - z @ np.linalg.lstsq(z, x, rcond=None)[0])


def with_free(errors: Before, found: Mapping[str, Free], which: int) -> Before:
    """The errors of `errors` with those of the free simulation beside them: `which` 0 before, 1 after."""
    of = {name: f.errors[which] for name, f in found.items()}
    by_load = {name: f.by_load[which] for name, f in found.items()}
    runs = {
        name: replace(e, free_kinematic_error_rms_arcsec=of.get(name), free_by_load_rest_rms_arcsec=by_load.get(name))
        for name, e in errors.per_run.items()
    }
    return Before(
        runs,
        replace(
            errors.pooled,
            free_kinematic_error_rms_arcsec=together(of.values()),
            free_by_load_rest_rms_arcsec=together(by_load.values()),
        ),
    )


def together(sizes: Iterable[float | None]) -> float | None:
    """RMS of some RMS, runs alike; None where one is not known, or there is none."""
    known = list(sizes)
    some = [size for size in known if size is not None]
    return float(np.sqrt(np.mean(np.square(some)))) if some and len(some) == len(known) else None


def curves_of(found: Mapping[str, Free]) -> dict[str, Array]:
    """free.<run>.turns, .measured, .before, .after: two motor turns, arcsec; free_rms.<run> (2,): before and after."""
    out: dict[str, Array] = {}
    for name, f in found.items():
        turns = np.abs(f.theta_m - f.theta_m[0]) / TURN
        near = slice(0, _one_way(turns, CLOSE_UP))
        stem = f"free.{name}"
        out |= {f"{stem}.turns": turns[near], f"{stem}.measured": f.measured[near]}
        out |= {f"{stem}.before": f.before[near], f"{stem}.after": f.after[near]}
        out[f"free_rms.{name}"] = np.array(f.errors)
    return out


def _one_way(turns: Array, most: float) -> int:
    """Rows until `most` turns are made, or the motor turns back: a line over its own way back cannot be read."""
    far = np.maximum.accumulate(turns)
    over = np.flatnonzero((turns > most) | (turns < far - BACK))
    if not over.size:
        return turns.size
    last = int(over[0])
    # where it turns back it unwinds on the spot: that is no curve over the angle
    return last if turns[last] > most else int(np.argmax(turns >= far[last] - BACK))
