"""Traces that never were, one for each verdict: three held-out runs, a locked one, and curves of every kind."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.answer import Candidate, NextRun, Status, Verdict
from rig.analysis.tracing.outcome.result import Before, Curve, Errors, Floor, Found, Trace
from rig.model.effect import parameter
from rig.report.trace.campaign import Provenance

Array = npt.NDArray[np.float64]
RUNS = {"slow_ke_2": (9.6, 0.0), "speed_400rpm_2": (404.0, 0.0), "load_40nm_2": (9.6, 40.0)}
COORDINATES = ("motor_angle", "load_angle", "direction", "load", "speed", "time")


def curves(after: float = 1.0, seed: int = 1) -> dict[str, Array]:
    """Every curve the page knows; `after` is the RMS over the floor that remains, 9 before."""
    rng = np.random.default_rng(seed)
    orders = np.arange(0.02, 40, 0.02)
    out = {"spectrum.motor_order": orders, "orders.motor_order": orders}
    out["angle.deg"], out["turn.load_deg"] = np.arange(360.0) + 0.5, np.arange(50) * 7.2 + 3.6
    for name, size in (("before", 9.0), ("after", after)):
        out[f"spectrum.{name}_arcsec"] = size * rng.rayleigh(0.02, orders.size)
        out[f"orders.M.{name}"] = size * rng.rayleigh(2e-5, orders.size)
        out[f"angle.{name}_arcsec"] = size * rng.normal(0, 0.2, 360)
        out[f"turn.{name}_arcsec"] = size * rng.normal(0, 0.1, 50)
    for channel in "AML":
        for coordinate in COORDINATES:
            bins = 2 if coordinate == "direction" else 12
            ends = {"direction": (-1, 1), "load": (-50, 50), "speed": (1, 400), "time": (0, 1600)}.get(
                coordinate, (7, 350)
            )
            stem = f"where.{channel}.{coordinate}"
            out[f"{stem}.x"] = np.linspace(*ends, bins)
            out[f"{stem}.before"], out[f"{stem}.after"] = rng.uniform(5, 9, bins), after * rng.uniform(0.9, 1.1, bins)
        out[f"interval.{channel}.before"] = np.array([7.7, 9.2]) * (1 if channel == "A" else 1e-3)
        out[f"interval.{channel}.after"] = np.array([0.95, 1.05]) * after * (1 if channel == "A" else 1e-3)
    out["share.A"] = np.array([0.11, 0.07, 0.0, 0.09, 0.1, 0.0, 0.0, 0.12, 0.88, 0.15, 0.05])
    for run, at in RUNS.items():
        out[f"run_at.{run}"] = np.array(at)
        turns = np.linspace(0, 2, 200)
        for channel, unit in (("A", 1.0), ("M", 1e-3), ("L", 1e-2)):
            stem, measured = f"close.{run}.{channel}", 60 * np.cos(4 * np.pi * turns)
            out |= {f"{stem}.turns": turns, f"{stem}.measured": unit * measured}
            out |= {f"{stem}.before": unit * 0.8 * measured, f"{stem}.after": unit * (measured + rng.normal(0, 1, 200))}
        out |= {f"free.{run}.{n}": out[f"close.{run}.A.{n}"] for n in ("turns", "measured", "before", "after")}
        out[f"free_rms.{run}"] = np.array([9.1, 2.3])
    torque = 60 * np.sin(np.linspace(0, 2 * np.pi, 400))
    loop = {"torque_Nm": torque, "windup_arcsec": 28 * torque + 20 * np.cos(np.linspace(0, 2 * np.pi, 400))}
    loop |= {"before_arcsec": 28 * torque, "after_arcsec": loop["windup_arcsec"] + rng.normal(0, 1, 400)}
    return out | {f"loop.lock_60_2.{name}": values for name, values in loop.items()}


def errors(theta: float, tau_m: float, tau_l: float) -> Errors:
    """In arcsec and N·m beside fixed floors."""
    return Errors(theta, tau_m, tau_l, 0.9, 0.002, 0.06)


def both(theta: float, tau_m: float) -> Before:
    """Every run alike; the locked one has no shaft torque equation."""
    per_run = dict.fromkeys(RUNS, errors(theta, tau_m, 0.06))
    return Before(per_run | {"lock_60_2": Errors(theta, None, None, 0.9)}, errors(theta, tau_m, 0.06))


def explained() -> Trace:
    """Load-dependent kinematic error, found."""
    effect = "load_dependent_kinematic_error"
    found = Found(effect, (parameter("A_inf", 0.4612, 0.011, "1"), parameter("lag", 0.0043, 0.0002, "s")), 0.99)
    sentence = (
        "The model lacks load dependent kinematic error: with it the error falls from 9.1 to 1.01 times the floor."
    )
    baseline = (parameter("K", 7160.0, 40.0, "N·m/rad"), parameter("J_m", 0.00163, 4e-6, "kg·m²"))
    order = parameter("theta_p_order_2", 40.1, 3.7, "arcsec")
    return Trace(
        campaign="made-up",
        simulated=True,
        fitted=("slow_ke_1", "load_40nm_1"),
        held_out=(*RUNS, "lock_60_2"),
        held_out_how="whole repeats, and whole loads and speeds between others",
        floors=(
            Floor("theta_l", 4.4e-6, "rad", "5 pairs of repeats compared at equal motor angle", (4.1e-6, 4.8e-6)),
            Floor("tau_m", 0.002, "N·m", "5 pairs of repeats compared at equal motor angle"),
        ),
        baseline=(*baseline, order),
        baseline_after=(
            parameter("K", 7300.0, 9.0, "N·m/rad"),
            baseline[1],
            parameter("theta_p_order_2", 62.4, 0.06, "arcsec"),
        ),
        cannot_be_told_apart=(("B_m", "B_ml"),),
        unexplained={"theta_l": 0.1},
        ratios_before={"theta_l": 9.1, "tau_m": 1.4, "tau_l": 1.0},
        ratios_after={"theta_l": 1.01, "tau_m": 1.0, "tau_l": 1.0},
        lives_in=("motor_angle", "load"),
        candidates=(
            Candidate(effect, 366000.0, "alone it removes 99 % of the excess", {"theta_l": 4.5e-6}),
            Candidate(
                "quadratic_drag", 40.0, "alone it removes 3 % of the excess, 60 % would be asked for", {"tau_m": 0.0031}
            ),
            Candidate("cogging_torque", 5.0, ""),
        ),
        verdict=Verdict(Status.EXPLAINED, (effect,), (), None, None, None, sentence),
        effects=(found,),
        before=both(8.2, 0.0028),
        after=both(0.91, 0.002),
        next_run=None,
        notes=("load_5nm_1 was left out: no 0.1 s of it without a gap.",),
        cannot=("Friction and thermal drift cannot be told apart here.",),
        curves=curves(),
    )


def nothing() -> Trace:
    """A clean campaign."""
    base = explained()
    verdict = Verdict(Status.NOTHING, (), (), None, None, None, "Nothing is missing: 0.99 times the floor.")
    quiet = {"theta_l": 1.0, "tau_m": 1.0, "tau_l": 1.0}
    clean = {k: v for k, v in base.curves.items() if not k.startswith("share.")}
    return replace(
        base,
        baseline_after=base.baseline,
        ratios_before=quiet,
        ratios_after=quiet,
        lives_in=(),
        candidates=(),
        verdict=verdict,
        effects=(),
        before=both(0.9, 0.002),
        after=both(0.9, 0.002),
        curves=clean,
    )


def ambiguous() -> Trace:
    """Quadratic drag or thermal drift: the plan decides neither."""
    base = explained()
    sentence = "The model lacks quadratic drag. These data fit as well with thermal_friction_drift."
    verdict = Verdict(Status.AMBIGUOUS, ("quadratic_drag",), ("thermal_friction_drift",), None, None, None, sentence)
    rivals = (Candidate("quadratic_drag", 400.0, ""), Candidate("thermal_friction_drift", 397.0, ""))
    because = "separates quadratic_drag from thermal_friction_drift: the same speed again shows what only time changes"
    found = Found("quadratic_drag", (parameter("D_2", 3.1e-6, 2e-7, "N·m·s²/rad²"),), 0.9)
    next_run = NextRun("sentinel", {"speed_rpm": 120.0}, because)
    return replace(base, verdict=verdict, candidates=rivals, effects=(found,), next_run=next_run)


def unknown() -> Trace:
    """A residual in the load angle that no effect explains."""
    base = explained()
    sentence = "What is left is 4.0 times the floor and follows no effect of the library; it lives in load angle."
    verdict = Verdict(Status.UNKNOWN, (), (), "load_angle", 37.0, None, sentence)
    after = {"theta_l": 4.0, "tau_m": 1.0, "tau_l": 1.0}
    return replace(
        base,
        verdict=verdict,
        effects=(),
        ratios_after=after,
        after=both(3.6, 0.002),
        lives_in=("load_angle",),
        curves=curves(after=4.0),
        added_curves=(Curve("load_angle", "theta_l", 37.0, None, 1.2),),
    )


ALL = {"explained": explained, "no_missing_effect": nothing, "ambiguous": ambiguous, "unknown_effect": unknown}


def source() -> Provenance:
    """Manifests of two of its runs."""
    manifest = {
        "procedure": "kinematic_error",
        "backend": "sim",
        "started_utc": "2026-11-01T09:09:48+00:00",
        "gear": {"ratio": 50, "serial": "CSF-14"},
        "conditions": {"tau_ext": -10.0, "output_locked": False},
        "software": {"version": "0.1.0", "commit": "abc"},
    }
    runs = {"slow_ke_1": manifest, "slow_ke_2": manifest, "standstill": manifest | {"procedure": "standstill"}}
    return Provenance(runs, {"version": "0.1.0", "commit": "def"}, "2026-11-02T10:00:00+00:00")
