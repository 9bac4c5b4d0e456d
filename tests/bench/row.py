"""One row of the table."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

from tests.bench.figure import Figure
from tests.bench.turns import Rounds


class Row(ABC):
    """What is measured, against what. The subclass's docstring says what was found on the way."""

    number: ClassVar[int]
    name: ClassVar[str]
    against: ClassVar[str]

    @abstractmethod
    def measure(self, rounds: Rounds) -> list[Figure]:
        """All sides in turn. Raises Unavailable when nothing of it can be measured here."""
