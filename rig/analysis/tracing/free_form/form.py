"""One form at one port: many columns, none of which means anything by itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

from rig.analysis.tracing.nameless.law import Nameless
from rig.model.effect import Array, Port, Reach, Shape, Signals


@dataclass(frozen=True)
class FreeForm(Nameless):
    """Columns made by `acting`; `words` say where it acts and along what. `wants`: channels without which it would
    foretell what it is made of. `surface`: over two coordinates."""

    words: str
    acting: Callable[[Signals], Mapping[Port, Array]]
    wants: frozenset[str] = frozenset()
    surface: bool = False

    name: ClassVar[str] = "free_form"
    in_short: ClassVar[str] = "a form without a name"
    source: ClassVar[str] = "hastie2009"

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where what it wants was read."""
        return ((),) if self.wants <= reach.has else ()

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """As they are made."""
        return self.acting(signals)
