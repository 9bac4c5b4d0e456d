"""One figure or table of the paper, made anew."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from rig.analysis.findings.result import Array
from rig.analysis.reproduction.claim import Claim, Number

Cell = str | float | Number


@dataclass(frozen=True)
class Exhibit:
    """`curves` for the drawing called `drawing`, or `columns` and `rows` of a table; neither where runs are missing."""

    number: str  # as in the paper, "Figure 7 a"
    title: str
    paper: str  # what the paper shows and says of it
    how: str  # from which runs, by what
    claims: tuple[Claim, ...]
    drawing: str = ""
    curves: Mapping[str, Array] = field(default_factory=dict)
    columns: tuple[str, ...] = ()
    rows: tuple[tuple[Cell, ...], ...] = ()
    missing: str = ""  # the runs it would take, "" where they are there

    @property
    def anchor(self) -> str:
        """figure-7-a"""
        return self.number.lower().replace(" ", "-")
