"""The speed that is slow enough: waveforms at falling speeds, the fastest that agrees, and what theory says of it."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from rig.analysis.at_speed.convergence_law import Law, SpeedStep, fit_law, speed_at
from rig.analysis.findings.collected import Findings
from rig.analysis.findings.result import Array, Estimate
from rig.analysis.kinematic_error.measure import groups_by_speed, measure
from rig.analysis.kinematic_error.profile import Profile, phasors
from rig.analysis.motion.declared import declared_gear
from rig.analysis.motion.source import Motion, Source
from rig.analysis.motion.strokes import Stroke, find_strokes
from rig.analysis.motion.window import part
from rig.analysis.sensors.in_step import in_step
from rig.analysis.smoothness.measure import smoothness
from rig.analysis.smoothness.words import sentence
from rig.analysis.turning.run import add_turning
from rig.core.numbers import number
from rig.core.quantiles import Z95
from rig.core.units import RPM, TURN
from rig.model.fourier import PAPER_ORDERS
from rig.model.linear import held_frequency, natural_frequency

TOLERANCE = 0.02  # of the waveform's rms, where the run does not say
ORDER2 = 0.01  # of C_2: how little it may change to the next slower speed
REPEATS = 2.0  # times its own uncertainty: a change below that is none
FEWEST = 3  # speeds
LAW = 0.03  # 1 σ of what damping and the loop's give shift the fitted frequency by, relative


def add_speed_convergence(found: Findings, run: Source, motion: Motion) -> None:
    """Add the kinematic error of the slowest speed, and which speed was slow enough."""
    strokes = [] if motion.theta_l is None or motion.t is None else find_strokes(motion)
    groups = groups_by_speed(motion, strokes) if strokes else []
    if len(groups) < FEWEST:
        found.cannot.append(
            f"The run holds {len(groups)} speeds, a search needs {FEWEST}: nothing is said of the speed."
        )
        add_turning(found, run, motion, None, slow=True)
        return
    steps: list[SpeedStep] = []
    for group in groups:
        step = _step(found, run, motion, group)
        if step is not None and not steps:
            lo, hi = min(s.start for s in group), max(s.stop for s in group)
            add_turning(found, run, part(motion, lo, hi), None, slow=True)
        steps += [step] if step is not None else []
    if len(steps) < FEWEST:
        found.inconclusive = f"{len(steps)} speeds ran smoothly, a search needs {FEWEST}."
        found.sentence = f"{found.inconclusive} {found.sentence}"
        return
    _conclude(found, run, _same_orders(steps))


def _step(found: Findings, run: Source, motion: Motion, group: list[Stroke]) -> SpeedStep | None:
    """θ̃ of one speed; None, and said why, where the motor did not run smoothly: that speed says nothing of the gear."""
    state = smoothness(motion, group, motion.pick(run.column("theta_ref")))
    ke = measure(run, motion, group, slow=False)
    if ke is None or state is None:
        return None
    turns = ke.profile.forward + ke.profile.reverse
    if not state.passed:
        found.cannot.append(f"{ke.speed_rpm:.3g} rpm is left out. {sentence(state)}")
        return None
    u = _u(ke.profile)
    if not np.isfinite(u).all():
        found.cannot.append(f"{ke.speed_rpm:.3g} rpm is left out: {turns} turns are too few to see them scatter.")
        return None
    if locked := in_step(run, motion, ke.speed_rpm):
        found.cannot.append(locked)
    return SpeedStep(ke.speed_rpm * RPM, phasors(ke.profile, ke.profile.terms), u, turns)


def _u(p: Profile) -> Array:
    """1 σ of one part of each order."""
    return np.asarray(np.sqrt(0.5 * (p.u_cosine**2 + p.u_sine**2)))


def _same_orders(steps: list[SpeedStep]) -> list[SpeedStep]:
    k = min(s.phasor.size for s in steps)
    return [SpeedStep(s.omega_m, s.phasor[:k], s.u[:k], s.revolutions) for s in steps]


def tolerance_of(conditions: Any) -> float:
    """What the run calls no change, relative."""
    found = number(conditions.get("tolerance"))
    return found if 0.0 < found < 1.0 else TOLERANCE


def changes(steps: list[SpeedStep]) -> list[tuple[float, float, float]]:
    """Of each speed against the next slower one, slowest first: (d, 1 σ of d by noise alone, |ΔC_2|/C_2), relative.

    d = rms(E_i − E_{i−1})/rms(E_{i−1}) over all orders; NaN for the slowest.
    """
    out = [(float("nan"), float("nan"), float("nan"))]
    for slow, fast in pairwise(steps):
        size = float(np.sqrt(np.sum(np.abs(slow.phasor) ** 2)))
        d = float(np.sqrt(np.sum(np.abs(fast.phasor - slow.phasor) ** 2))) / size
        noise = float(np.sqrt(2.0 * np.sum(fast.u**2 + slow.u**2))) / size
        second = slow.phasor[1] if slow.phasor.size > 1 else slow.phasor[0]
        change = abs(abs(fast.phasor[min(1, fast.phasor.size - 1)]) - abs(second)) / abs(second)
        out.append((d, noise, float(change)))
    return out


def chosen(steps: list[SpeedStep], tolerance: float) -> int | None:
    """The fastest of the speeds that agrees with the next slower one, as does every slower one. None: none does."""
    best = None
    for i, (d, noise, order2) in enumerate(changes(steps)[1:], start=1):
        if not (d < max(tolerance, REPEATS * noise) and order2 < ORDER2):
            break
        best = i
    return best


def agreement(omega_m: float, law: Law, tolerance: float) -> str:
    """What the fastest speed [rad/s] that agrees with its neighbour is worth: close neighbours agree long before."""
    early = law.resolved and omega_m > law.speed_at(tolerance)
    return f"{omega_m / RPM:.3g} rpm is the fastest of the speeds run that agrees with the next slower one" + (
        f", though speed adds more than {100 * tolerance:g} % there" if early else ""
    )


def _conclude(found: Findings, run: Source, steps: list[SpeedStep]) -> None:
    tolerance, law = tolerance_of(run.conditions), fit_law(steps)
    best = chosen(steps, tolerance)
    basis = f"{len(steps)} speeds, {steps[0].omega_m / RPM:.3g} to {steps[-1].omega_m / RPM:.3g} rpm"
    words = [_limit(found, law, steps, tolerance, basis)]
    if best is not None:
        speed = steps[best].omega_m / RPM
        how = (
            f"Fastest of {basis} whose waveform differs from that of the next slower one by less than "
            f"{100 * tolerance:g} % of its rms (or twice the noise) and 1 % of order 2, as do all slower ones."
        )
        found.exact("chosen_speed", "Fastest speed of the grid that agrees", speed, "rpm", how)
        words.append(agreement(steps[best].omega_m, law, tolerance))
    else:
        found.inconclusive = "The waveform still changes between the two slowest speeds: run slower."
        words.insert(0, found.inconclusive.rstrip("."))
    _prediction(found, run, law, steps, best, tolerance)
    _table(found, law, steps, tolerance)
    told = "; ".join(words)
    found.sentence = f"{told[:1].upper()}{told[1:]}. {found.sentence}"


def _limit(found: Findings, law: Law, steps: list[SpeedStep], tolerance: float, basis: str) -> str:
    """The speed at which the fitted law reaches the tolerance."""
    speed = law.speed_at(tolerance) / RPM
    if not law.resolved:
        fastest = steps[-1].omega_m / RPM
        found.cannot.append(
            f"Up to {fastest:.3g} rpm the waveform does not grow with speed beyond its scatter: the speed at which it "
            f"would by {100 * tolerance:g} % cannot be extrapolated."
        )
        return f"no growth with speed up to {fastest:.3g} rpm"
    u = float(np.hypot(law.u_relative, LAW))
    half = Z95 * u * speed
    beyond = " (extrapolated beyond the speeds run)" if speed > steps[-1].omega_m / RPM else ""
    how = (
        f"Where θ̃_n = θ̃_p,n/(1 − (nΩ/ω_0)²), fitted to all orders at {basis}, differs from standstill by "
        f"{100 * tolerance:g} % of the rms{beyond}; interval from the scatter of the turns (χ² per degree of freedom "
        f"{law.misfit:.2f}) and {100 * LAW:g} % (1 σ) for damping and the give of the loop, which the law leaves out."
    )
    found.figure("speed_limit", f"Speed at which speed adds {100 * tolerance:g} %", speed, "rpm", half, how)
    frequency = law.omega_0 / TURN
    how = f"From the growth with speed at {basis}, motor held by its loop; the fit's ω_0/2π."
    found.figure("held_frequency", "Frequency of the load on the gear", frequency, "Hz", Z95 * u * frequency, how)
    return f"speed adds {100 * tolerance:g} % at {speed:.3g} ± {half:.2g} rpm{beyond}"


def _prediction(
    found: Findings, run: Source, law: Law, steps: list[SpeedStep], best: int | None, tolerance: float
) -> None:
    """What the declared inertias and stiffness say for the same waveform and tolerance."""
    gear = declared_gear(run)
    if gear is None:
        found.cannot.append("J_m, J_l or K is not declared: theory's speed cannot be said.")
        return
    held, free = held_frequency(gear.K, gear.J_l), natural_frequency(gear)
    low, high = (speed_at(law.pure, omega, tolerance) / RPM for omega in (held, free))
    found.estimates.append(
        Estimate(
            "speed_limit_predicted",
            f"The same by linear theory, {100 * tolerance:g} %",
            low,
            "rpm",
            (low, high),
            "From the declared J_m, J_l and K for the measured waveform: the value with the motor held fast, upper end "
            "with the motor free; a position loop lies nearer the former. Only the waveform is of this run.",
        )
    )
    if best is not None:
        share = 100.0 * (PAPER_ORDERS * steps[best].omega_m / free) ** 2
        how = f"({PAPER_ORDERS}Ω/ω_n)² with ω_n = {free / TURN:.2f} Hz from the declared J_m, J_l and K."
        found.exact(
            "highest_order_predicted", f"Growth of order {PAPER_ORDERS} at that speed, by theory", share, "%", how
        )


def _table(found: Findings, law: Law, steps: list[SpeedStep], tolerance: float) -> None:
    size = float(np.sqrt(np.sum(np.abs(law.pure) ** 2)))
    rows: list[dict[str, float | str]] = []
    for step, (d, noise, order2) in zip(steps, changes(steps), strict=True):
        u = float(np.sqrt(2.0 * np.sum(step.u**2 + law.u_pure**2))) / size
        away = float(np.sqrt(np.sum(np.abs(step.phasor - law.pure) ** 2))) / size
        rows.append(
            {
                "speed_rpm": step.omega_m / RPM,
                "turns": float(step.revolutions),
                "change_percent": 100 * d,
                "noise_percent": 100 * noise,
                "order_2_change_percent": 100 * order2,
                "from_standstill_percent": 100 * float(np.sqrt(max(away**2 - u**2, 0.0))),
                "from_standstill_u_percent": 100 * u,
                "law_percent": 100 * by_law if np.isfinite(by_law := law.deviation(step.omega_m)) else float("nan"),
            }
        )
    found.tables["speeds"] = rows
    grid = np.geomspace(0.5 * steps[0].omega_m, 2.0 * steps[-1].omega_m, 120)
    curve = np.array([law.deviation(float(omega)) for omega in grid])
    keep = np.isfinite(curve) & (curve < 1.0) & law.resolved
    found.curve(
        convergence__speed_rpm=np.array([r["speed_rpm"] for r in rows], float),
        convergence__deviation=np.array([r["from_standstill_percent"] for r in rows], float),
        convergence__u=np.array([r["from_standstill_u_percent"] for r in rows], float),
        convergence__law_rpm=grid[keep] / RPM if keep.any() else None,
        convergence__law=100 * curve[keep] if keep.any() else None,
        convergence__tolerance=np.array([100 * tolerance]),
    )
