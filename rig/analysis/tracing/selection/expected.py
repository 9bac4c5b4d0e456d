"""What a run that was not made yet would tell two effects apart by: information expected from the fit's own columns.

With f the effect as fitted, and everything else (baseline and the rival g) free to explain it, the sum of squares that
remains, over the noise, is D = c_f'·(G_ff − G_fo·G_oo⁻¹·G_of)·c_f. A run adds to the normal matrix G what its own
motion makes of the columns; D with it less D without is what it tells, √ in standard deviations.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import BASELINE, CHANNELS
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.led import follow, lead, model_of
from rig.analysis.tracing.fit.model import Design, Solution, design, extended, fit, solve
from rig.analysis.tracing.fit.rows import is_measured, rows
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.runs.sliding import direction
from rig.core.units import RPM
from rig.model.effect import MEASURED, Array, Signals

TWICE: Final = 2  # every run is repeated
SETTING_UP: Final = 120.0  # s, to hang a weight or lock the output and check it


@dataclass(frozen=True)
class Proposal:
    """A run the rig can make: motor speed [rad/s] over time, weight [N·m], or torque against the lock [N·m]."""

    procedure: str
    conditions: Mapping[str, float | bool | str]
    speed: Array
    tau_ext: float = 0.0
    locked: Array | None = None
    by_hand: bool = False

    def cost(self, dt: float) -> float:
        """s of rig time, twice for a repeat."""
        return TWICE * self.speed.size * dt + (SETTING_UP if self.by_hand else 0.0)


def proposals(dt: float) -> list[Proposal]:
    """The catalogue's runs, each in the size the plans have."""
    out = [
        Proposal("constant_torque", {"speed_rpm": rpm}, np.full(round(10 / dt), rpm * RPM))
        for rpm in (60.0, 200.0, 400.0, 500.0)
    ]
    steps = (15.0, 30.0, 60.0, 120.0, 200.0, 310.0, 400.0, 500.0)
    both = [sign * rpm * RPM for sign in (1, -1) for rpm in steps]
    stairs = np.repeat(both, round(4 / dt))
    out.append(
        Proposal(
            "friction", {"speeds_rpm": ",".join(f"{r:g}" for r in steps), "output_deg": 4.0, "breakaways": 1}, stairs
        )
    )
    slow = np.repeat([9.6 * RPM, -9.6 * RPM], round(50 / dt))
    out.append(Proposal("kinematic_error", {}, slow))
    out += [Proposal("kinematic_error", {"tau_ext": -w}, slow, -w, by_hand=True) for w in (10.0, 40.0)]
    wave = np.concatenate([np.linspace(0, 1, 1500), np.linspace(1, -1, 3000), np.linspace(-1, 0, 1500)])
    nested = np.concatenate([5.0 * wave, 20.0 * wave])
    out.append(Proposal("stiffness_lock", {"output_locked": True}, np.zeros(nested.size), locked=nested, by_hand=True))
    return out


def imagined(proposal: Proposal, like: Recording, s: Solution, start: float) -> Recording:
    """The run as the baseline expects it, without noise, `start` s after the campaign's first."""
    piece, model = like.pieces[0], model_of(s)
    n, dt = proposal.speed.size, piece.dt
    nothing, t = np.zeros(n), start + dt * np.arange(n, dtype=np.float64)
    bare = Signals(
        t=t, dt=dt, ratio=piece.ratio, theta_m=nothing, theta_l=nothing, omega_m=nothing, alpha_m=nothing,
        omega_l=nothing, alpha_l=nothing, torque=nothing, torque_rate=nothing, tau_m=nothing,
        tau_l=nothing, tau_ext=np.full(n, proposal.tau_ext), way=nothing, temperature=nothing * np.nan, gear=model.gear,
    )  # fmt: skip
    if proposal.locked is not None:
        made = _wound(bare, proposal.locked)
    else:
        window = np.hanning(round(0.4 / dt))  # s, how quickly a loop changes its speed
        omega = np.convolve(proposal.speed, window / window.sum(), mode="same")
        theta = np.cumsum(omega) * dt
        turned = replace(bare, theta_m=theta, omega_m=omega, alpha_m=np.gradient(omega, dt), way=direction(omega, dt))
        made = follow(turned, model, lead(turned, model, nothing), nothing, nothing)
    return replace(
        like, name=proposal.procedure, procedure=proposal.procedure, said="imagined", pieces=(made,), start=start,
        locked=proposal.locked is not None, has=MEASURED, counts_m=0.0, counts_l=0.0,
    )  # fmt: skip


def _wound(s: Signals, torque: Array) -> Signals:
    """The gear wound up against a lock: the motor goes where stiffness and kinematic error put it."""
    g = s.gear
    theta = s.ratio * torque / g.K
    for _ in range(3):  # θ̃_p moves the motor by a hundredth of a turn
        theta = s.ratio * (torque / g.K + g.kinematic_error.value(theta))
    omega = np.gradient(theta, s.dt)
    return replace(
        s, theta_m=theta, omega_m=omega, alpha_m=np.gradient(omega, s.dt), torque=torque, tau_l=torque,
        torque_rate=np.gradient(torque, s.dt), way=direction(omega, s.dt),
    )  # fmt: skip


def sigmas(s: Solution, f: Term, g: Term, fitted: Sequence[int], proposed: Sequence[Proposal]) -> list[float]:
    """Standard deviations by which each proposed run, made twice after the campaign, tells f from g. `s`: baseline."""
    eq = s.design.eq
    last = max(float(p.t[-1]) for i in fitted for p in eq.runs[i].pieces)
    like = next(eq.runs[i] for i in fitted)
    made = [imagined(p, like, s, last) for p in proposed]
    runs = (*eq.runs, *made)
    more = {(len(eq.runs) + j, c): rows(r, c) for j, r in enumerate(made) for c in CHANNELS if is_measured(r, c)}
    wide = replace(eq, runs=runs, rows={**eq.rows, **{k: r for k, r in more.items() if r.y.size}}, noisy={}, own={})
    alone = fit(extended(s.design, f, fitted))
    c = alone.x[alone.design.place(len(alone.design.terms) - 1)]
    core = extended(extended(s.design, f, fitted), g, fitted)
    place = core.place(len(core.terms) - 2)
    before = unexplained(core.gram, place, c)
    out = []
    for j in range(len(made)):
        gram = _aligned(design(wide, core.terms, [len(eq.runs) + j]), core)
        out.append(float(np.sqrt(max(0.0, unexplained(core.gram + TWICE * gram, place, c) - before))))
    return out


def _aligned(d: Design, core: Design) -> Array:
    """The normal matrix of `d` at the places of `core`: a term that does not act in a run has no columns there."""
    at = np.concatenate(
        [np.arange(len(BASELINE))] + [np.arange(core.size)[core.place(i)] for i, wide in enumerate(d.widths) if wide]
    )
    out = np.zeros((core.size, core.size))
    out[np.ix_(at, at)] = d.gram
    return out


def unexplained(gram: Array, place: slice, c: Array) -> float:
    """D of the columns at `place` with coefficients `c`, all others free."""
    mine = np.arange(gram.shape[0])[place]
    others = np.setdiff1d(np.arange(gram.shape[0]), mine)
    across = gram[np.ix_(others, mine)] @ c
    return float(c @ gram[np.ix_(mine, mine)] @ c - across @ solve(gram[np.ix_(others, others)], across))
