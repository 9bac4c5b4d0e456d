"""Tables of a result as text: the Fourier coefficients with their intervals, any other table as it comes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from rig.report.numbers import ABSENT, estimate, plain, quantity
from rig.report.words import SUFFIXES, humanise

Cell = float | str
K95 = 1.96  # from a standard uncertainty to the half width of a 95 % interval, where a row has no "k95" of its own


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
    return [(_coefficients if name == "coefficients" else _any)(name, found[name]) for name in order if found[name]]


def number(row: Mapping[str, Cell], key: str) -> float:
    """The number in a cell; NaN when it is absent or text."""
    value = row.get(key)
    return float(value) if isinstance(value, int | float) else math.nan


def _with_u(row: Mapping[str, Cell], key: str, u: str) -> str:
    k95 = number(row, "k95")
    return quantity(number(row, key), (k95 if math.isfinite(k95) else K95) * number(row, u))


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


def _any(name: str, rows: Sequence[Mapping[str, Cell]]) -> Table:
    keys = list(dict.fromkeys(key for row in rows for key in row))
    columns = [Column(_head(key), any(isinstance(row.get(key), str) for row in rows)) for key in keys]
    cells = [[_cell(row.get(key)) for key in keys] for row in rows]
    return Table(f"table-{slug(name)}", humanise(name), "", columns, cells)


def _cell(value: Cell | None) -> str:
    return plain(value, 5) if isinstance(value, int | float) else ABSENT if value is None else value


def _head(key: str) -> str:
    stem, _, suffix = key.rpartition("_")
    return f"{humanise(stem)}, {SUFFIXES[suffix]}" if stem and suffix in SUFFIXES else humanise(key)


def slug(name: str) -> str:
    """A name fit for an anchor."""
    return "".join(c if c.isascii() and c.isalnum() else "-" for c in name)
