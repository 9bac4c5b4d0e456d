"""Table 2: the Fourier coefficients of the pure kinematic error."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.kinematic_error.measure import KinematicError
from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.claim import Claim, Number, at_least, missing
from rig.analysis.reproduction.exhibit import Cell, Exhibit
from rig.analysis.reproduction.split import words

TITLE = "Fourier coefficients of θ̃_p"
PAPER = "a_n and b_n of fifteen orders. The numbers are lost from the text at hand; that order 2 leads is not."
DEGREES = 3600.0 / 1e3  # arcsec in 10⁻³ degrees, the table's unit
MOST = 50.0  # % of the mean square
LEADS = "Order 2 is most of it"
COLUMNS = ("n", "a_n, 10⁻³ °", "b_n, 10⁻³ °", "C_n, arcsec")


def table(campaign: Campaign) -> Exhibit:
    """All orders of the slow run, 95 % intervals from the scatter of its turns."""
    pure = campaign.pure()
    if pure is None:
        lacking = "It takes a slow run without load."
        return Exhibit("Table 2", TITLE, PAPER, "", (missing(LEADS, lacking),), missing=lacking)
    reading, error = pure
    p = error.profile
    rows = tuple(_row(error, n) for n in range(p.terms))
    how = f"{words(reading, error)}; ± is the 95 % interval."
    claims = (leads(p.amplitude, p.factor * p.u_amplitude),)
    return Exhibit("Table 2", TITLE, PAPER, how, claims, columns=COLUMNS, rows=rows)


def _row(error: KinematicError, i: int) -> tuple[Cell, ...]:
    p = error.profile
    u = np.hypot((p.u_cosine[i], p.u_sine[i]), p.u_system[i]) * p.factor / DEGREES
    a, b = p.cosine[i] / DEGREES, p.sine[i] / DEGREES
    size = Number.of(float(p.amplitude[i]), float(p.factor * p.u_amplitude[i]), "")
    return (f"{i + 1}", Number.of(float(a), float(u[0]), ""), Number.of(float(b), float(u[1]), ""), size)


def leads(amplitude: Array, half: Array) -> Claim:
    """Share of order 2 in the mean square, from amplitudes (k,) and half widths, arcsec."""
    if amplitude.size < 2:
        return missing(LEADS, "Too few orders were resolved.")
    whole = float(np.sum(amplitude**2))
    rest = whole - float(amplitude[1] ** 2)
    value = 100.0 * float(amplitude[1] ** 2) / whole
    slope = 2.0 * amplitude * np.where(np.arange(amplitude.size) == 1, rest, -float(amplitude[1] ** 2)) / whole**2
    share = Number.of(value, 100.0 * float(np.sqrt(np.sum((slope * half) ** 2))), "%")
    rule = f"Order 2's share of the mean square of fifteen orders: at least {MOST:g} %, with its 95 % interval."
    return Claim(LEADS, at_least(share, MOST), "{} of the mean square.", (share,), rule)
