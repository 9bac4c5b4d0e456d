"""Free simulation of the model before and after on held-out runs, beside what was measured."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from rig.analysis.angle import ARCSEC
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.outcome.replay import GONE, Model, model_of, replayed, shown
from rig.analysis.tracing.outcome.result import Before
from rig.analysis.tracing.runs.recording import Recording
from rig.model.effect import Array

if TYPE_CHECKING:
    from rig.analysis.tracing.trace import Prepared

TURN: Final = 2 * np.pi
CLOSE_UP: Final = 2.0  # motor turns
FEWEST: Final = 200  # rows after the start is forgotten


@dataclass(frozen=True)
class Free:
    """One run: motor angle (n,) rad, kinematic error measured and simulated (n,) arcsec, each less its mean."""

    theta_m: Array
    measured: Array
    before: Array
    after: Array

    @property
    def errors(self) -> tuple[float, float]:
        """RMS of simulated less measured, before and after, arcsec."""
        left = (self.before - self.measured, self.after - self.measured)
        return float(np.std(left[0])), float(np.std(left[1]))


def free(p: Prepared, before: Solution, after: Solution) -> dict[str, Free]:
    """Of the fastest held-out run, where the gear's own dynamics are most of it, and the most loaded one, by name; {}
    where no held-out run turns freely with both angles, or motion and effects do not settle."""
    models = model_of(before), model_of(after)
    out: dict[str, Free] = {}
    for key in _chosen(p):
        found = _simulated(p, key, models)
        if found is not None:
            out[p.eq.runs[key[0]].name] = found
    return out


def _chosen(p: Prepared) -> list[Key]:
    runs = p.eq.runs
    able = [k for k in ((i, "A") for i in p.court.runs) if k in p.eq.rows and not runs[k[0]].locked]
    able = [k for k in able if {"t", "theta_l"} <= runs[k[0]].has]
    fastest = max(able, key=lambda k: runs[k[0]].turning, default=None)
    loaded = max(able, key=lambda k: abs(float(runs[k[0]].pieces[0].tau_ext[0])), default=None)
    return list(dict.fromkeys(k for k in (fastest, loaded) if k is not None))


def _simulated(p: Prepared, key: Key, models: tuple[Model, Model]) -> Free | None:
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
    before, after, seen = (ARCSEC * _own_out(p, key, x, keep, here) for x in (*columns, measured))
    return Free(theta, seen, before, after + _vibration(p, run, keep, seen - after))


def _vibration(p: Prepared, run: Recording, keep: Array, left: Array) -> Array:
    """What a named vibration makes of `left` (n,), in the phase this run has; zero where none is named."""
    named = p.own.parameters.get("external_vibration")
    if named is None:
        return np.zeros(left.size)
    x = 2 * np.pi * named[0].value * np.arange(keep.size)[keep] * run.smoother.dt * run.smoother.step
    z = np.stack([np.cos(x), np.sin(x)], 1)
    return np.asarray(z @ np.linalg.lstsq(z, left, rcond=None)[0])


def _own_out(p: Prepared, key: Key, x: Array, keep: Array, here: Array) -> Array:
    """Less its mean, and without the steps that the run has to itself."""
    own = p.eq.own.get(key)
    z = np.ones((x.size, 1)) if own is None else np.hstack([np.ones((x.size, 1)), own[: here.size][here]])
    return np.asarray(x - z @ np.linalg.lstsq(z, x, rcond=None)[0])


def with_free(errors: Before, found: Mapping[str, Free], which: int) -> Before:
    """The errors of `errors` with those of the free simulation beside them: `which` 0 before, 1 after."""
    of = {name: f.errors[which] for name, f in found.items()}
    runs = {name: replace(e, free_kinematic_error_rms_arcsec=of.get(name)) for name, e in errors.per_run.items()}
    both = float(np.sqrt(np.mean(np.square([*of.values()])))) if of else None
    return Before(runs, replace(errors.pooled, free_kinematic_error_rms_arcsec=both))


def curves_of(found: Mapping[str, Free]) -> dict[str, Array]:
    """free.<run>.turns, .measured, .before, .after: two motor turns, arcsec; free_rms.<run> (2,): before and after."""
    out: dict[str, Array] = {}
    for name, f in found.items():
        turns = np.abs(f.theta_m - f.theta_m[0]) / TURN
        near = turns <= CLOSE_UP
        stem = f"free.{name}"
        out |= {f"{stem}.turns": turns[near], f"{stem}.measured": f.measured[near]}
        out |= {f"{stem}.before": f.before[near], f"{stem}.after": f.after[near]}
        out[f"free_rms.{name}"] = np.array(f.errors)
    return out
