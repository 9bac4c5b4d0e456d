"""The decomposition as a person is shown it: θ̃_s by order beside the linear prediction, and the three curves."""

from __future__ import annotations

import numpy as np

from rig.analysis.at_speed.decomposition import Decomposition, decompose, slow_profile
from rig.analysis.findings.collected import Findings
from rig.analysis.findings.intervals import amplitude_interval
from rig.analysis.findings.result import Check, Estimate
from rig.analysis.findings.unbiased import phasor_draws, unbiased
from rig.analysis.kinematic_error.measure import KinematicError, groups_by_speed, measure
from rig.analysis.kinematic_error.profile import DRAWS
from rig.analysis.motion.source import Motion, Source, motion_of
from rig.analysis.motion.strokes import find_strokes
from rig.analysis.motion.tame import Tame
from rig.analysis.motion.window import measured_window, part
from rig.analysis.orders.revolutions import GRID
from rig.analysis.orders.wave import wave
from rig.core.quantiles import Z95
from rig.core.units import DEG

NO_REFERENCE = (
    "The part of θ̃ that the gear's flexibility makes needs a slow run of the same gear: put one in the same campaign, "
    "or name it with --reference."
)


def add_decomposition(found: Findings, run: Source, motion: Motion, reference: Source | None) -> None:
    """θ̃_s of the settled part of `run` with the slow run `reference`; says why where it cannot."""
    if reference is None:
        found.cannot.append(NO_REFERENCE)
        return
    slow_run = Tame(reference)
    slow_motion = motion_of(slow_run)
    slow = None if slow_motion is None else slow_profile(slow_run, slow_motion)
    window = measured_window(run, motion)
    fast = _main(run, part(motion, window.lo, window.hi))
    split = None if slow is None or fast is None else decompose(run, fast, slow.profile)
    if slow is None or fast is None or split is None:
        found.cannot.append(f"θ̃ could not be split with {reference.name}: one of the two runs has no kinematic error.")
        return
    basis = (
        f"θ̃ at {fast.speed_rpm:.4g} rpm less the pure kinematic error of {reference.name} ({slow.speed_rpm:.3g} rpm)"
    )
    found.checks.append(Check("alignment", not split.alignment.odd, split.alignment.sentence))
    found.figure(
        "alignment_shift",
        "Angle between the zeros of the two runs",
        split.alignment.fitted / DEG,
        "°",
        Z95 * split.alignment.u_fitted / DEG,
        f"Shift of the motor angle at which {basis} agree best, all orders weighted by their uncertainty.",
    )
    _figures(found, split, basis)
    if split.ratio is None:
        found.cannot.append("J_m, J_l or K is not declared: the linear prediction of θ̃_s cannot be made.")


def _main(run: Source, motion: Motion) -> KinematicError | None:
    """θ̃ of the speed that was held longest."""
    strokes = [] if motion.theta_l is None else find_strokes(motion)
    if not strokes:
        return None
    groups = groups_by_speed(motion, strokes)
    return measure(run, motion, max(groups, key=lambda g: sum(s.revolutions for s in g)), slow=False)


def _figures(found: Findings, split: Decomposition, basis: str) -> None:
    value, low, high = peak_to_peak(split)
    how = f"{basis}; interval by Monte Carlo from the scatter of both runs' turns."
    found.estimates.append(Estimate("flexible_peak_to_peak", "θ̃_s, peak to peak", value, "arcsec", (low, high), how))
    found.tables["decomposition"] = rows = [_row(split, n) for n in range(split.total.size)]
    for row in rows:
        n, resolved = int(row["order"]), float(row["flexible_lo"]) > 0
        if n in (2, 4) or (resolved and n in (6, 8)):
            how = f"{basis}, order {n}; interval from the scatter of both runs' turns"
            if "predicted" in row:
                how += f"; linear theory with the declared inertias and stiffness says {row['predicted']:.3g} arcsec"
            ci95 = (float(row["flexible_lo"]), float(row["flexible_hi"]))
            label = f"θ̃_s, amplitude of order {n}"
            found.estimates.append(
                Estimate(f"flexible_amplitude_{n}", label, float(row["flexible"]), "arcsec", ci95, f"{how}.")
            )
    theta = (np.arange(GRID) + 0.5) / GRID * 360.0
    predicted = split.predicted
    found.curve(
        decomposition__theta_deg=theta,
        decomposition__total=wave(split.total),
        decomposition__pure=wave(split.pure),
        decomposition__flexible=wave(split.flexible),
        decomposition__order=np.arange(1.0, split.total.size + 1),
        decomposition__measured=np.array([row["flexible"] for row in rows], float),
        decomposition__low=np.array([row["flexible_lo"] for row in rows], float),
        decomposition__high=np.array([row["flexible_hi"] for row in rows], float),
        decomposition__predicted=None if predicted is None else np.abs(predicted),
    )


def peak_to_peak(split: Decomposition) -> tuple[float, float, float]:
    """(value, low, high) of θ̃_s over one turn, arcsec; the upward bias by noise is taken off."""
    noise = phasor_draws(DRAWS, split.u.size)
    sizes = np.array([np.ptp(wave(split.flexible + split.u * draw)) for draw in noise])
    value, scatter = unbiased(float(np.ptp(wave(split.flexible))), sizes)
    half = split.factor * scatter
    return value, max(value - half, 0.0), value + half


def _row(split: Decomposition, i: int) -> dict[str, float | str]:
    """One order, arcsec; the gains are |θ̃_n|/|θ̃_p,n|, measured and by linear theory."""
    value, low, high = amplitude_interval(float(abs(split.flexible[i])), float(split.u[i]), split.factor)
    pure = float(abs(split.pure[i]))
    row: dict[str, float | str] = {
        "order": float(i + 1),
        "at_speed": float(abs(split.total[i])),
        "pure": pure,
        "flexible": value,
        "flexible_lo": low,
        "flexible_hi": high,
        "gain": float(abs(split.total[i])) / pure if pure > 0 else float("nan"),
    }
    if split.ratio is not None and split.predicted is not None and split.u_ratio is not None:
        row["predicted"] = float(abs(split.predicted[i]))
        row["u_predicted"] = float(split.u_ratio[i]) * pure
        row["gain_predicted"] = float(abs(split.ratio[i]))
    return row
