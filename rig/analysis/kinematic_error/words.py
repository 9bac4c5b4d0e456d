"""Kinematic error as a person is shown it: figures, tables, curves, and what the run cannot tell."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.collected import Findings
from rig.analysis.findings.figure_names import SHOWN_ORDERS
from rig.analysis.findings.intervals import amplitude_interval
from rig.analysis.findings.result import Array, Check, Estimate, Part
from rig.analysis.kinematic_error.measure import KinematicError
from rig.analysis.kinematic_error.profile import SMALL, Profile, chosen_terms, truncation
from rig.analysis.orders.revolutions import GRID
from rig.core.quantiles import Z95
from rig.core.units import DEG
from rig.model.fourier import PAPER_ORDERS

CURVES = 400  # revolutions drawn at most
TRIFLE = 0.01  # of the peak to peak: with so much left, orders that no figure has move it by a few times as much


def add_profile(found: Findings, ke: KinematicError, pure: bool) -> None:
    """Peak to peak, amplitudes, counts, the table of coefficients. `pure`: a slow run, where inertia hardly speaks."""
    p = ke.profile
    what = "Kinematic error" if pure or not np.isfinite(ke.speed_rpm) else f"θ̃ at {ke.speed_rpm:.4g} rpm"
    parts = "even part of both directions" if p.odd_cosine is not None else "one direction only"
    basis = f"{p.forward} forward and {p.reverse} reverse revolutions, {parts}"
    _add_peak_to_peak(found, ke, pure, what, basis)
    _add_amplitudes(found, ke, what, basis)
    how = "Whole motor turns used; half a turn is cut at each reversal and where the run began or ended at rest."
    found.exact("revolutions_forward", "Revolutions forward", p.forward, "1", how)
    found.exact("revolutions_reverse", "Revolutions reverse", p.reverse, "1", how)
    how = (
        "Single rows less trend and series of their own revolution: quantisation, noise, orders above the last; "
        "interval from the scatter of the revolutions."
    )
    rms, half = p.residual_rms
    found.figure("residual_rms", "Residual of the series, rms", rms, "arcsec", half, how)
    if np.isfinite(ke.speed_rpm):
        speeds = np.abs(np.concatenate([s.speed_rpm for s in ke.strokes]))
        half = Z95 * float(speeds.std()) / np.sqrt(speeds.size)
        found.figure("mean_speed", "Mean motor speed", ke.speed_rpm, "rpm", half, "Mean over the revolutions used.")


def _add_peak_to_peak(found: Findings, ke: KinematicError, pure: bool, what: str, basis: str) -> None:
    p = ke.profile
    value, (low, high) = p.peak_to_peak()
    how = f"Peak to peak of the {p.terms}-order series over {basis}"
    if np.isfinite(low):
        how += (
            f"; interval by Monte Carlo from the scatter of the revolutions (Student t, {p.dof:.0f} degrees of freedom)"
            ", upward bias by noise taken off"
        )
    else:
        how += "; too few revolutions for an interval"
    if ke.added_known and pure:
        share = 100 * float(ke.added[min(1, p.terms - 1)])
        how += f"; what inertia adds ({share:.2g} % of order 2) is taken off, half of it is in the interval"
    found.estimates.append(
        Estimate(
            "kinematic_error_peak_to_peak", f"{what}, peak to peak", value, "arcsec", (low, high), how + ".",
            parts_of(p, (high - low) / 2, p.system_half),
        )
    )  # fmt: skip


def _add_amplitudes(found: Findings, ke: KinematicError, what: str, basis: str) -> None:
    """The table of coefficients, and a figure for each order that is resolved and shown, for order 2 always."""
    p = ke.profile
    found.tables["coefficients"] = rows = coefficients(p, ke.u_zero)
    for row in rows:
        n, resolved = int(row["order"]), float(row["C_lo"]) > 0
        if n == 2 or (resolved and n in SHOWN_ORDERS):
            state = "" if resolved else "Not resolved from zero, only the upper end of the interval is a result. "
            state = state if np.isfinite(float(row["C_lo"])) else "Too few revolutions for an interval. "
            how = f"{state}{basis}; least squares over exact turns, interval from the scatter of the revolutions."
            ci95 = (float(row["C_lo"]), float(row["C_hi"]))
            label = f"{what}, amplitude of order {n}"
            made_of = parts_of(p, (ci95[1] - ci95[0]) / 2, p.factor * float(p.u_system[n - 1]))
            found.estimates.append(
                Estimate(f"fourier_amplitude_{n}", label, float(row["C_arcsec"]), "arcsec", ci95, how, made_of)
            )


def parts_of(p: Profile, half: float, system: float) -> tuple[Part, ...]:
    """What an interval of `half` [arcsec] is made of, `system` of it by what does not scatter."""
    if not np.isfinite(half):
        return ()
    scatter = float(np.sqrt(max(half**2 - system**2, 0.0)))
    number = p.forward + p.reverse
    return (
        Part(
            f"the scatter of {number} revolutions", scatter, "take more of them, it falls with the root of their number"
        ),
        Part("what inertia adds at this speed", system, "run slower, or declare J_l and K better"),
    )


def coefficients(p: Profile, u_zero: float) -> list[dict[str, float | str]]:
    """One row an order, arcsec and deg. u_* are 1 σ and k95 their factor; *_lo to *_hi are 95 % intervals; the phase is
    NaN where not resolved.

    `u_zero` [rad]: a count is as wide as it is, so the angle that phases are counted from is known to that; it turns
    (a_n, b_n) by n·u_zero without changing C_n, and no repetition shows it.
    """
    rows: list[dict[str, float | str]] = []
    for n in range(p.terms):
        a, b, size = float(p.cosine[n]), float(p.sine[n]), float(p.amplitude[n])
        share, turn = float(p.u_system[n]) / size if size else 0.0, (n + 1) * u_zero
        value, low, high = amplitude_interval(size, float(p.u_amplitude[n]), p.factor)
        across = float(np.hypot(b * p.u_cosine[n], a * p.u_sine[n])) / max(size, 1e-150) ** 2
        u_a = float(np.sqrt(p.u_cosine[n] ** 2 + (share * a) ** 2 + (turn * b) ** 2))
        u_b = float(np.sqrt(p.u_sine[n] ** 2 + (share * b) ** 2 + (turn * a) ** 2))
        row: dict[str, float | str] = {
            "order": float(n + 1),
            "k95": p.factor,
            "a_arcsec": a,
            "u_a": u_a,
            "a_lo": a - p.factor * u_a,
            "a_hi": a + p.factor * u_a,
            "b_arcsec": b,
            "u_b": u_b,
            "b_lo": b - p.factor * u_b,
            "b_hi": b + p.factor * u_b,
            "C_arcsec": value,
            "C_lo": low,
            "C_hi": high,
            "phase_deg": float(np.arctan2(b, a)) / DEG if low > 0 else float("nan"),
            "u_phase": float(np.hypot(across, turn)) / DEG if low > 0 else float("nan"),
        }
        rows.append(row)
    return rows


def add_series(found: Findings, ke: KinematicError, pure: bool) -> None:
    """How many orders are worth keeping, and the curves of the profile over one motor turn."""
    p = ke.profile
    curve = p.pure()
    mse = truncation(curve, p.terms)
    k = chosen_terms(mse, p.floor)
    how = (
        f"Smallest k with MSE(k) ≤ 1.1·MSE({p.terms}) = {1.1 * mse[-1]:.3g} arcsec², or below the noise floor of the "
        f"averaged curve, {p.floor:.3g} arcsec²."
    )
    found.exact("fourier_terms", "Orders worth keeping", k, "1", how)
    found.curve(
        ke__theta_deg=np.linspace(0.0, 360.0, GRID, endpoint=False) + 180.0 / GRID,
        ke__revolutions_forward=_drawn(ke, 1),
        ke__revolutions_reverse=_drawn(ke, -1),
        ke__mean_forward=p.curve_forward,
        ke__mean_reverse=p.curve_reverse,
        ke__pure=curve,
        ke__at_speed=None if pure else np.array([ke.speed_rpm]),
        ke__direction=p.direction(),
        ke__fit=p.fit(),
        mse__k=np.arange(mse.size, dtype=np.float64),
        mse__value=mse,
        mse__floor=np.array([p.floor]) if np.isfinite(p.floor) else None,
    )
    table = found.tables["coefficients"]
    low, high = np.array([r["C_lo"] for r in table], float), np.array([r["C_hi"] for r in table], float)
    found.curve(
        orders__order=np.arange(1.0, p.terms + 1),
        orders__amplitude=np.array([r["C_arcsec"] for r in table], float),
        orders__ci95=(high - low) / 2,
    )


def _drawn(ke: KinematicError, direction: int) -> Array | None:
    """The revolutions of one direction (R, G), each less its mean; evenly thinned when there are very many."""
    curves = [s.curves for s in ke.strokes if s.direction == direction]
    if not curves:
        return None
    joined = np.concatenate(curves)
    joined = joined[:: -(-joined.shape[0] // CURVES)]
    return np.asarray(joined - joined.mean(axis=1, keepdims=True))


def add_trend(found: Findings, ke: KinematicError) -> None:
    """What goes on top of the profile: along the output stroke, between the directions, with time."""
    trend = ke.trend
    if trend.offset is not None:
        value, half = trend.offset
        how = (
            f"Half of forward minus reverse mean at equal output angle (the whole gap is {2 * value:.4g} arcsec): load "
            "friction over stiffness, lost motion, or encoders read at different times; this run cannot say which."
        )
        found.figure("direction_offset", "Direction offset (order 0 of the odd part)", value, "arcsec", half, how)
    if trend.slope is not None and trend.peak_to_peak is not None:
        back = trend.offset is not None
        cause = "It comes back at the same angle" if back else "Run in one direction, drift with time is in it too"
        over = f"over {trend.covered_deg:.1f}° of the output"
        how = f"{cause}: output-side eccentricity or wind-up, {over}; taken off before the series."
        found.figure("trend_slope", "Trend over the output stroke", *_value(trend.slope, "arcsec/deg"), how)
        value, half = trend.peak_to_peak
        label, ci95 = "Trend, peak to peak over the stroke", (max(value - half, 0.0), value + half)
        found.estimates.append(Estimate("trend_peak_to_peak", label, value, "arcsec", ci95, how))
    if trend.drift is not None:
        how = "The part that follows time, not the output angle: temperature, friction warming up, encoder drift."
        found.figure("drift", "Drift of θ̃ with time", *_value(trend.drift, "arcsec/min"), how)


def _value(figure: tuple[float, float], unit: str) -> tuple[float, str, float]:
    return figure[0], unit, figure[1]


def cut_short(found: Findings, ke: KinematicError) -> str:
    """Why the peak to peak is no whole one where the rows are too few per turn for all orders; "" where it is, or what
    is left of the rows is a trifle."""
    p = ke.profile
    if p.terms >= PAPER_ORDERS:
        return ""
    said = f"The rows are too few per turn for {PAPER_ORDERS} orders: the series ends at order {p.terms}."
    found.cannot.append(said)
    whole, (rms, _) = p.peak_to_peak()[0], p.residual_rms
    if rms < TRIFLE * whole:
        return ""
    said += f" Beside {whole:.4g} arcsec peak to peak it leaves {rms:.3g} arcsec rms: take more rows per turn."
    found.checks.append(Check("orders", False, said))
    return said


def add_limits_of_the_run(found: Findings, ke: KinematicError, ratio: float, output: str, pure: bool) -> None:
    """What this run cannot tell, and why. `output`: the manifest's gear.output."""
    p, tell = ke.profile, found.cannot.append
    if p.odd_cosine is None:
        tell(
            "Whole turns of one direction only: direction effects (friction, lag, lost motion) stay in the profile, "
            "and the offset between directions is unknown."
        )
    longest = max(s.mean.size for s in ke.strokes)
    if longest < ratio / 2:
        tell(
            f"The longest stroke has {longest} whole turn{'' if longest == 1 else 's'}: order {_two(ratio, output)} "
            f"need {ratio / 2:.0f} in one direction to be told apart."
        )
    if ke.trend.covered_deg < 360.0:
        tell(
            f"What is used of the run covers {ke.trend.covered_deg:.1f}° of the output: errors once per output turn "
            "look like a trend; a full turn shows them. (Even then, load-encoder eccentricity and runout of the output "
            "look alike.)"
        )
    if p.dof < 1:
        tell("One revolution does not repeat: there is no scatter to make intervals from.")
    if p.rho > 0:
        tell(
            f"Neighbouring revolutions are not independent (correlation {p.rho:.2f}): something changes over several "
            "turns; the intervals are widened for it."
        )
    if pure and not ke.added_known:
        tell("J_l or K is not declared: what inertia adds to the error at this speed is not in the intervals.")
    if pure and ke.added_known and float(ke.added.max()) > SMALL:
        n = int(np.argmax(ke.added > SMALL)) + 1
        tell(f"At {ke.speed_rpm:.3g} rpm inertia may add more than 10 % to order {n} and above: run slower for those.")
    if not pure:
        tell(
            "At this speed θ̃ holds the pure kinematic error and what the gear's flexibility makes of it; the pure part "
            "needs a slow run in both directions."
        )


def _two(ratio: float, output: str) -> str:
    """The pair of orders that the two toothed parts make of their two-lobed errors."""
    if output == "circular_spline":
        return f"2 (fixed to the flexspline) and {2 - 2 / ratio:.4g} (fixed to the circular spline)"
    return f"2 (fixed to the circular spline) and {2 + 2 / ratio:.4g} (fixed to the flexspline)"
