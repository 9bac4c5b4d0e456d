"""Tables of a result as text: the Fourier coefficients with their intervals, any other table as it comes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from rig.core.quantiles import Z95
from rig.report.numbers import ABSENT, estimate, plain, quantity
from rig.report.words import SUFFIXES, humanise

Cell = float | str


class Column(NamedTuple):
    """The head of a column, and whether words stand below it rather than numbers."""

    head: str
    text: bool = False


class Table(NamedTuple):
    """A table ready to print; the first cell of each row heads it. `tight`: fits a phone when set small."""

    anchor: str
    title: str
    note: str
    columns: list[Column]
    rows: list[list[str]]
    tight: bool = False


def tables(found: Mapping[str, Sequence[Mapping[str, Cell]]]) -> list[Table]:
    """All tables that have rows, coefficients first."""
    order = sorted(found, key=lambda name: name != "coefficients")
    return [OWN.get(name, _any)(name, found[name]) for name in order if found[name]]


def number(row: Mapping[str, Cell], key: str) -> float:
    """The number in a cell; NaN when it is absent or text."""
    value = row.get(key)
    return float(value) if isinstance(value, int | float) else math.nan


def _with_u(row: Mapping[str, Cell], key: str, u: str) -> str:
    k95 = number(row, "k95")
    return quantity(number(row, key), (k95 if math.isfinite(k95) else Z95) * number(row, u))


def _amplitude(row: Mapping[str, Cell]) -> str:
    return estimate(number(row, "C_arcsec"), (number(row, "C_lo"), number(row, "C_hi")))


COLUMNS: tuple[tuple[str, str, Callable[[Mapping[str, Cell]], str]], ...] = (
    ("order", "n", lambda row: plain(number(row, "order"))),
    ("a_arcsec", "aₙ", lambda row: _with_u(row, "a_arcsec", "u_a")),
    ("b_arcsec", "bₙ", lambda row: _with_u(row, "b_arcsec", "u_b")),
    ("C_arcsec", "Cₙ", _amplitude),
    ("phase_deg", "ψₙ, °", lambda row: _with_u(row, "phase_deg", "u_phase")),
)


def _coefficients(name: str, rows: Sequence[Mapping[str, Cell]]) -> Table:
    shown = [(head, cell) for key, head, cell in COLUMNS if any(key in row for row in rows)]
    return Table(
        name,
        "Fourier coefficients",
        "Kinematic error = Σ aₙ cos nθ + bₙ sin nθ = Σ Cₙ cos(nθ − ψₙ), θ the wave-generator angle, n in cycles per "
        "turn of it; a, b and C in arcsec at the output. Intervals are 95 %; a phase is given where the amplitude is "
        "told from zero.",
        [Column(head) for head, _ in shown],
        [[cell(row) for _, cell in shown] for row in rows],
        tight=True,
    )


LOADS: tuple[tuple[str, str, Callable[[Mapping[str, Cell]], str]], ...] = (
    ("depth_mm", "Depth, mm", lambda row: plain(number(row, "depth_mm"))),
    ("load_nm", "Load, N·m", lambda row: plain(number(row, "load_nm"))),
    ("assemblies", "Assemblies", lambda row: plain(number(row, "assemblies"))),
    ("peak_to_peak_arcsec", "Peak to peak", lambda row: _between(row, "peak_to_peak_arcsec", "low", "high")),
    (
        "change_arcsec",
        "Less the reference depth",
        lambda row: _between(row, "change_arcsec", "change_low", "change_high"),
    ),
    ("band_low_arcsec", "Band of one fitting", lambda row: _span(row, "band_low_arcsec", "band_high_arcsec")),
)


def _between(row: Mapping[str, Cell], key: str, low: str, high: str) -> str:
    ends = number(row, f"{low}_arcsec"), number(row, f"{high}_arcsec")
    return estimate(number(row, key), ends) if math.isfinite(number(row, key)) else ABSENT


def _span(row: Mapping[str, Cell], low: str, high: str) -> str:
    ends = number(row, low), number(row, high)
    return f"{plain(ends[0], 4)} to {plain(ends[1], 4)}" if all(map(math.isfinite, ends)) else ABSENT


def _by_load(name: str, rows: Sequence[Mapping[str, Cell]]) -> Table:
    shown = [(head, cell) for key, head, cell in LOADS if any(key in row for row in rows)]
    deep = any("change_arcsec" in row for row in rows)
    note = "Peak to peak of the kinematic error, arcsec; ± are 95 % intervals."
    more = (
        " Where an interval of the difference holds 0, fitting the wave generator anew could have made it. The band is "
        "where 95 of 100 single fittings at the reference depth lie."
    )
    return Table(
        f"table-{slug(name)}",
        "By depth and load" if deep else "By load",
        note + (more if deep else ""),
        [Column(head) for head, _ in shown],
        [[cell(row) for _, cell in shown] for row in rows],
    )


def _any(name: str, rows: Sequence[Mapping[str, Cell]]) -> Table:
    keys = list(dict.fromkeys(key for row in rows for key in row))
    columns = [Column(_head(key), any(isinstance(row.get(key), str) for row in rows)) for key in keys]
    cells = [[_cell(row.get(key)) for key in keys] for row in rows]
    return Table(f"table-{slug(name)}", humanise(name), "", columns, cells)


OWN: Mapping[str, Callable[[str, Sequence[Mapping[str, Cell]]], Table]] = {
    "coefficients": _coefficients,
    "assembly": _by_load,
    "loads": _by_load,
}
"""Tables with a look of their own; any other is shown as it comes."""


def _cell(value: Cell | None) -> str:
    return plain(value, 5) if isinstance(value, int | float) else ABSENT if value is None else value


HEADS = {  # of keys whose name says too little
    "motor_torque": "Motor torque, N·m",
    "motor_side": "Motor side, N·m",
    "load_side": "Load side, N·m",
    "seconds": "Duration, s",
    "local_stiffness_N·m/rad": "Local stiffness, N·m/rad",
    "interval_±": "±, N·m/rad",
    "windup_rate_arcmin/s": "Rate of wind-up, arcmin/s",
    "direction": "Direction, ±1",
    "u": "1 σ",
    "odd_torque_Nm": "Odd torque, N·m",
    "at_speed": "At speed, arcsec",
    "pure": "Pure, arcsec",
    "flexible": "Flexible, arcsec",
    "flexible_lo": "from, arcsec",
    "flexible_hi": "to, arcsec",
    "predicted": "Predicted, arcsec",
    "u_predicted": "1 σ of it, arcsec",
    "gain_predicted": "Gain predicted",
    "change_percent": "Change, %",
    "noise_percent": "Noise, %",
    "order_2_change_percent": "Change of order 2, %",
    "from_standstill_percent": "From standstill, %",
    "from_standstill_u_percent": "1 σ of it, %",
    "law_percent": "By the law, %",
    "u_arcsec": "1 σ, arcsec",
    "u_phase": "1 σ of the phase, °",
    "arcsec": "Amplitude, arcsec",
    "lo": "from, arcsec",
    "hi": "to, arcsec",
}


def _head(key: str) -> str:
    if key in HEADS:
        return HEADS[key]
    stem, _, suffix = key.rpartition("_")
    return f"{humanise(stem)}, {SUFFIXES[suffix]}" if stem and suffix in SUFFIXES else humanise(key)


def slug(name: str) -> str:
    """A name fit for an anchor."""
    return "".join(c if c.isascii() and c.isalnum() else "-" for c in name)
