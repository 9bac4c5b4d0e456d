"""The table: a line per figure."""

from __future__ import annotations

from dataclasses import dataclass

from tests.bench.figure import Figure
from tests.bench.row import Row

COLUMNS = ("#", "what", "figure", "median", "p10 to p90", "target", "verdict", "load before, after")


@dataclass(frozen=True)
class Measured:
    """A row with its figures and the load average before and after them."""

    row: Row
    figures: list[Figure]
    before: float
    after: float


def lines_of(measured: Measured) -> list[str]:
    """One line per figure, in Markdown."""
    out = []
    for i, figure in enumerate(measured.figures):
        first = i == 0
        cells = (
            str(measured.row.number) if first else "",
            f"{measured.row.name}; against {measured.row.against}" if first else "",
            figure.name,
            number(figure.median, figure.unit) if len(figure.values) else "–",
            " to ".join(number(x, figure.unit) for x in figure.spread()) if len(figure.values) else "–",
            f"{figure.target}",
            figure.verdict(),
            f"{measured.before:.1f}, {measured.after:.1f}" if first else "",
        )
        out.append("| " + " | ".join(cells) + " |")
    return out


def number(x: float, unit: str) -> str:
    """Three digits and the unit."""
    return f"{x:.3g} {unit}".rstrip()


def table(measured: list[Measured], head: str, remarks: list[str]) -> str:
    """The whole file."""
    top = ["# hdrig beside the limit and beside its peers", "", head, "", *remarks, ""]
    head_of_table = ["| " + " | ".join(COLUMNS) + " |", "|" + " --- |" * len(COLUMNS)]
    return "\n".join([*top, *head_of_table, *(line for m in measured for line in lines_of(m))]) + "\n"
