"""Orders of θ̃ over the longest stroke: a fine spectrum, and the lines that stand out of it."""

from __future__ import annotations

from rig.analysis.findings.collected import Findings
from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Motion
from rig.analysis.motion.strokes import Stroke
from rig.analysis.orders.lines import Line, find_lines, fit_lines, spectrum
from rig.analysis.orders.revolutions import trend_degree
from rig.analysis.orders.sums import fit, legendre, without
from rig.core.units import DEG
from rig.model.fourier import PAPER_ORDERS

SPECTRUM_TO = 40.0  # orders of the motor drawn
LINES_TO = 150.0  # orders searched: tooth mesh of a ratio-50 gear is 102
SLOWEST = 0.3  # orders; a cage of rolling elements makes 0.4, below stand output orders, friction and drift
LINES_FROM = 20  # turns a stroke needs before a line between the whole orders means anything
OUTPUT_ORDERS = (1, 2, 3, 4)  # per output turn, looked at when the stroke has one


def add_orders(found: Findings, motion: Motion, stroke: Stroke) -> None:
    """Fine order spectrum of the longest stroke, and the lines in it when it is long enough to place them."""
    theta = motion.theta_m[stroke.start : stroke.stop]
    error = motion.error_arcsec(stroke.start, stroke.stop)
    orders, amplitude = spectrum(theta, _less_trend(theta, error, 1), SPECTRUM_TO)
    found.curve(spectrum__order=orders, spectrum__amplitude=amplitude)
    if stroke.revolutions < LINES_FROM:
        return
    # what the output does in so few of its turns is no line yet, and would leak into all others
    slow = trend_degree(float(stroke.revolutions), stroke.revolutions)
    lines = find_lines(
        theta, _less_trend(theta, error, slow), LINES_TO, slowest=SLOWEST, known=tuple(range(1, PAPER_ORDERS + 1))
    )
    found.tables["lines"] = [_line_row(line, motion.ratio) for line in lines]
    if stroke.revolutions >= motion.ratio - 1:
        per_output = [k / motion.ratio for k in OUTPUT_ORDERS]
        lines = fit_lines(theta, _less_trend(theta, error, 1), per_output)
        found.tables["output_lines"] = [_line_row(line, motion.ratio) for line in lines]


def _less_trend(theta: Array, y: Array, degree: int) -> Array:
    """`y` less a polynomial in `theta`."""
    scale = 2.0 / float(theta[-1] - theta[0])

    def columns(lo: int, hi: int) -> Array:
        return legendre((theta[lo:hi] - theta[0]) * scale - 1.0, degree)

    return without(columns, y, fit(columns, y))


def _line_row(line: Line, ratio: float) -> dict[str, float | str]:
    return {
        "order": line.order,
        "per_output_turn": line.order * ratio,
        "amplitude_arcsec": line.amplitude,
        "u_arcsec": line.u,
        "phase_deg": line.phase / DEG,
        "u_phase": line.u_phase / DEG,
        "resolution": line.resolution,
    }
