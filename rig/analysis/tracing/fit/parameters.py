"""Coefficients in the words of the field, with intervals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rig.analysis.tracing.fit.beside_zero import beside_its_zero
from rig.analysis.tracing.fit.channels import INDEX, ORDERS, SERIES
from rig.analysis.tracing.fit.covariance import between_runs, covariance
from rig.analysis.tracing.fit.curves import Compliance, Curves
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.late_reading import beside_a_late_reading
from rig.analysis.tracing.fit.learnt import damping_of
from rig.analysis.tracing.fit.model import UNSEEN, Solution, extended, fit, solve
from rig.analysis.tracing.fit.refine import nudged
from rig.analysis.tracing.fit.returning import by_what_returns
from rig.analysis.tracing.fit.rows import third_rate
from rig.core.quantiles import Z95
from rig.core.units import ARCSEC
from rig.model.effect import Array, Effect, Fit, Parameter, parameter

PLAIN = {
    "J_m": "kg·m²",
    "B_m": "N·m·s/rad",
    "tau_c": "N·m",
    "J_l": "kg·m²",
    "B_l": "N·m·s/rad",
    "tau_cl": "N·m",
    "lag": "s",
    "gain": "1",
    "lag_m": "s",
}

CONSTANTS = (*PLAIN, "compliance", "damping", "inertia")  # all of the baseline but θ̃_p, the same whatever the run

ROUNDS = 4  # each leaves a fiftieth of what the one before left
NO_LAG = 1e-9  # s
STEP = 1e-4  # relative, of a coefficient or shape: figures are smooth in them
MEAN = 0.3  # of what laws in the spring do to B_sp: a mean slope of theirs is taken for that at every torque
LEAST = 0.5  # of what is fitted: below it the series has no sum that its terms would tell


def inertias_by_what_returns(s: Solution, runs: Sequence[int]) -> tuple[Parameter, ...]:
    """`baseline`, with inertias that know nothing of what scatters within a run nor of a motor's torque that is read
    late, and all others beside them. How far
    shapes of effects are known is in all intervals: a spring that gets stiffer beyond all torques of the fitted `runs`
    leaves its K open."""
    s, unsure = beside_a_late_reading(s)
    moved, (fitted, _) = by_what_returns(s), _loose(s)
    spread = _widened(s, fitted, runs, covariance) if fitted else covariance(s).copy()
    spread[: s.x.size, : s.x.size] += moved.more + unsure
    constants = [INDEX[name] for name in CONSTANTS]
    spread[constants, constants] += between_runs(s)[constants]
    return baseline(replace(s, x=moved.x), spread, fitted)


def baseline(s: Solution, spread: Array | None = None, slopes: Sequence[tuple[int, int]] = ()) -> tuple[Parameter, ...]:
    """K, B_sp, inertias, damping, friction and the largest orders of θ̃_p, those that were measured; `spread` is the
    covariance (p + s, p + s) of the coefficients and of the logarithms of shapes that are loose, (term, which of its)
    in `slopes`."""
    c, out = covariance(s) if spread is None else spread, list[Parameter]()
    seen = np.diag(s.gram) > UNSEEN
    late = INDEX["lag"]  # which is believed to be small, and no more than that is known where no load is balanced
    seen[late] &= s.design.gram[late, late] > UNSEEN
    if seen[INDEX["compliance"]]:
        out += _of_the_spring(s, c, slopes)
    out += [_of(n, s.value(n), _unit(c, n), c, unit) for n, unit in PLAIN.items() if seen[INDEX[n]]]
    out = [beside_its_zero(p, s, c) for p in out]
    out = [_from_the_reading(p, s.design.forward) if p.name == "lag" else p for p in out]
    if any(run.look.inertia for run in s.design.eq.runs):
        known = s.design.eq.runs[0].gear.J_l + s.value("inertia")
        out.append(_of("J_l", known, _unit(c, "inertia"), c, PLAIN["J_l"]))
    out = [_at_its_bound(s, p) if p.name == "lag" and p.value < NO_LAG else p for p in out]
    if seen[INDEX["a1"]]:
        out += [_order(s, c, n) for n in range(1, ORDERS + 1)]
    return tuple(out)


def _of_the_spring(s: Solution, c: Array, slopes: Sequence[tuple[int, int]]) -> list[Parameter]:
    """K near zero torque and, of a spring that is not straight, under load; B_sp. None of what is no spring."""
    curves = Curves(s, _of_the_gear(s, c), slopes)
    near, swings = curves.near_zero(), curves.swinging()
    stiff = swings.stiffness
    if not np.isfinite([near.stiffness, stiff]).all():
        return []
    out = [near.told("K", c), *([curves.under_load().told("K_under_load", c)] if curves.are_there() else [])]
    damping, lag = damping_of(s.value("damping"), stiff, s.value("lag")), s.value("lag")
    both = _unit(c, "damping") * -(stiff**2) + _unit(c, "lag") * stiff
    both += swings.by * (2 * s.value("damping") * stiff - lag) * stiff**2
    found = _of("B_sp", _of_the_series(s, damping, stiff), both, c, "N·m·s/rad")
    plain = damping_of(s.value("damping"), curves.fitted.stiffness, lag)
    found = _wider(found, MEAN * abs(damping - plain))
    return [*out, _beside_the_mesh(found, stiff * lag, s)]


def _wider(p: Parameter, by: float) -> Parameter:
    return replace(p, ci95=(p.ci95[0] - by, p.ci95[1] + by))


def _of_the_gear(s: Solution, c: Array) -> Compliance:
    """1/K of the gear alone: without what effects in series with it give way by, which the fitted one has too."""
    compliance, by = s.value("compliance"), _unit(c, "compliance")
    for i, term in enumerate(s.design.terms):
        more, gradient = term.effect.softens(of_term(s, c, i))
        compliance -= more
        by[s.design.place(i)] -= gradient
    return Compliance(compliance, by)


def _beside_the_mesh(damping: Parameter, late: float, s: Solution) -> Parameter:
    """B_sp, of which `late` (K times the delay of the torque that is left) may not be a delay's: B_ml drags by what the
    motor swings against the load, which the load's balance has no column for and a delay stands in for. Of B_ml nothing
    is known but that it is no more than all the motor's drag, and it acts with N times the lever."""
    most = s.design.eq.runs[0].ratio * max(s.value("B_m"), 0.0) if s.gram[INDEX["B_m"], INDEX["B_m"]] > UNSEEN else 0.0
    return replace(damping, ci95=(damping.ci95[0] - min(max(late, 0.0), most), damping.ci95[1]))


def _from_the_reading(lag: Parameter, forward: float) -> Parameter:
    """A delay that is left, with what was taken off the reading before."""
    return replace(lag, value=lag.value + forward, ci95=(lag.ci95[0] + forward, lag.ci95[1] + forward))


def _at_its_bound(s: Solution, lag: Parameter) -> Parameter:
    """No delay, for no sensor is early: as late as it may be by an interval that knows of no bound."""
    unbound = replace(s, gram=s.design.gram + np.diag(s.design.prior))
    half = Z95 * float(np.sqrt(max(0.0, covariance(unbound)[INDEX["lag"], INDEX["lag"]])))
    return replace(lag, value=0.0, ci95=(0.0, half))


def _of_the_series(s: Solution, damping: float, stiffness: float) -> float:
    """B_sp, where A has three terms of T/(K + B_sp·d/dt) and the fourth, −B_sp³/K⁴·T⃛, has gone into the second: a tenth
    of a radian of phase, as at 15 Hz, makes it 1 % too small. As omitted columns bias those that are there
    [angrist2009, Eq. 3.2.11]."""
    keys = [key for key in s.keys if key[1] == "A"]
    eq, right = s.design.eq, np.zeros(s.x.size)
    for key in keys:
        z, at = s.design.whole(key)
        right[at] += eq.noise.weight("A") * (z.T @ eq.bare(key, third_rate(eq.runs[key[0]])[eq.rows[key].keep]))
    share = solve(s.gram, right)[INDEX["damping"]] / stiffness**2  # of B_sp³
    found = damping
    for _ in range(ROUNDS):
        found = damping / max(1 + share * found**2, LEAST)
    return found


def _order(s: Solution, c: Array, n: int) -> Parameter:
    """Amplitude of an order of θ̃_p, without load where an effect makes it shrink under one."""
    waves = np.array([_unit(c, f"a{n}"), _unit(c, f"b{n}")])
    for i, term in enumerate(s.design.terms):
        more = term.effect.unloaded(n, s.design.eq.runs[0].gear, term.shape)
        if more.size:
            waves[:, s.design.place(i)] = more
    both = waves[:, : s.x.size] @ s.x
    size = max(float(np.hypot(*both)), 1e-15)
    return _of(f"theta_p_order_{n}", size / ARCSEC, both @ waves / size / ARCSEC, c, "arcsec")


def _unit(c: Array, name: str) -> Array:
    out = np.zeros(c.shape[0])
    out[INDEX[name]] = 1.0
    return out


def _of(name: str, value: float, along: Array, c: Array, unit: str) -> Parameter:
    return parameter(name, value, Z95 * float(np.sqrt(max(0.0, float(along @ c @ along)))), unit)


def effects(
    s: Solution, runs: Sequence[int], spread: Callable[[Solution], Array] = covariance
) -> dict[str, tuple[Parameter, ...]]:
    """Parameters of every effect in the model; the shape's uncertainty is in all intervals, which are as wide as
    `spread` says. That of an exponent which is a textbook's is in its own interval alone: the others are those of
    the textbook's law."""
    fitted, usual = _loose(s)
    slopes = [*fitted, *usual]
    c = _widened(s, fitted, runs, spread)
    if usual:
        c = _beside(c, _widened(s, slopes, runs, spread))
    told: dict[str, list[Told]] = {}
    for i, term in enumerate(s.design.terms):
        by = _spread(s, len(c), i, slopes)
        told.setdefault(term.name, []).append(Told(term.effect, of_term(s, c, i, slopes), by))
    return {name: joined(terms, c) for name, terms in told.items()}


def _loose(s: Solution) -> tuple[list[tuple[int, int]], list[tuple[int, int]]]:
    """Shape parameters that are not fixed, as (term, which of its): those that were fitted, and a textbook's."""
    terms = s.design.terms
    loose = [(i, j) for i, term in enumerate(terms) for j, free in enumerate(term.effect.loose) if free]
    usual = [slope for slope in loose if _is_usual(terms[slope[0]], slope[1])]
    return [slope for slope in loose if slope not in usual], usual


def _is_usual(term: Term, j: int) -> bool:
    return term.shape[j] in term.effect.usual.get(term.effect.shape_names[j], ())


def _widened(
    s: Solution, slopes: Sequence[tuple[int, int]], runs: Sequence[int], spread: Callable[[Solution], Array]
) -> Array:
    """Covariance (p, p) of all coefficients and of the logarithms of those shape parameters."""
    d = s.design
    for i, j in slopes:
        term = s.design.terms[i]
        # what is left without its noise of a slope that is mostly noise is held still: it would seem to be known
        d = extended(d, nudged(term, j, s.x[s.design.place(i)], noise_kept=True), runs)
    # about the solution itself: the added columns only widen the intervals
    return spread(replace(fit(d), x=np.concatenate([s.x, np.zeros(len(slopes))])))


def _beside(c: Array, whole: Array) -> Array:
    """Covariance `c` (p, p) of the first coefficients, and of the others what `whole` (q, q) says of them alone."""
    out = whole.copy()
    out[: len(c)] = out[:, : len(c)] = 0.0
    out[: len(c), : len(c)] = c
    return out


@dataclass(frozen=True)
class Told:
    """One term of an effect, what the fit says of it, and `by`: its coefficients and shape by all that is fitted."""

    effect: Effect
    fit: Fit
    by: Array  # (k + s, p)


def joined(terms: Sequence[Told], c: Array) -> tuple[Parameter, ...]:
    """Figures of all terms of one effect, of which `c` (p, p) is the covariance: what it `adds` is one figure, with
    the interval of all of them, for two terms of one effect are seldom independent; of the others that have the same
    name the second is numbered."""
    out: dict[str, Parameter] = {}
    for term in terms:
        for p in term.effect.parameters(term.fit):
            if p.name not in out:
                out[p.name] = p
            elif p.name not in term.effect.adds:
                name = f"{p.name}_{sum(n.startswith(p.name) for n in out) + 1}"
                out[name] = replace(p, name=name)
    if len(terms) > 1:
        out |= {name: _together(name, out[name].unit, terms, c) for name in out if name in terms[0].effect.adds}
    return tuple(out.values())


def _together(name: str, unit: str, terms: Sequence[Told], c: Array) -> Parameter:
    """A figure that terms of one effect have together."""
    along = np.zeros(len(c))
    for i, term in enumerate(terms):
        along += _gradient(name, terms, i) @ term.by
    total = terms[0].effect.together(name, [term.fit for term in terms])
    return parameter(name, total, Z95 * float(np.sqrt(max(0.0, float(along @ c @ along)))), unit)


def _gradient(name: str, terms: Sequence[Told], i: int) -> Array:
    """Of a figure of all `terms` by coefficients and shape of one (k + s,), by central differences of what the effect
    makes of them."""
    effect, fits = terms[i].effect, [term.fit for term in terms]
    at = np.concatenate([fits[i].coefficients, fits[i].shape])
    k, out = fits[i].coefficients.size, np.zeros(at.size)
    loose = np.concatenate([np.ones(k, bool), np.array(effect.loose or (False,) * len(fits[i].shape), bool)])
    for j in np.flatnonzero(loose):
        step = STEP * (abs(at[j]) or float(np.abs(at[:k]).max()))
        ends = [at + sign * step * (np.arange(at.size) == j) for sign in (1.0, -1.0)]
        moved = [replace(fits[i], coefficients=x[:k], shape=tuple(x[k:])) for x in ends]
        there = [effect.together(name, [*fits[:i], fit, *fits[i + 1 :]]) for fit in moved]
        out[j] = (there[0] - there[1]) / (2 * step)
    return out


def of_term(s: Solution, c: Array, i: int, slopes: Sequence[tuple[int, int]] = ()) -> Fit:
    """The part of coefficients and covariance that belongs to one term."""
    by, first = _spread(s, len(c), i, slopes), s.design.eq.runs[0]
    place = s.design.place(i)
    beside = np.vstack([by, np.eye(len(c))[[INDEX[name] for name in SERIES]]])
    joint = beside @ c @ beside.T
    k = len(by)
    tau_c = s.value("tau_c") if s.gram[INDEX["tau_c"], INDEX["tau_c"]] > UNSEEN else None
    return Fit(s.x[place], s.design.terms[i].shape, joint[:k, :k], first.gear, first.ratio, joint, tau_c)


def _spread(s: Solution, size: int, i: int, slopes: Sequence[tuple[int, int]]) -> Array:
    """Coefficients and shape of a term by all that is fitted, (k + s, `size`)."""
    term, place = s.design.terms[i], s.design.place(i)
    k = place.stop - place.start
    by = np.zeros((k + len(term.shape), size))
    by[np.arange(k), np.arange(place.start, place.stop)] = 1.0
    for at, (owner, j) in enumerate(slopes):
        if owner == i:  # the column is the change with the logarithm
            by[k + j, s.design.size + at] = term.shape[j]
    return by
