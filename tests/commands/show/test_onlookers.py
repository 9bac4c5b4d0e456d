"""Everyone who looks on is told everything."""

from __future__ import annotations

import inspect

from rig.commands.show.onlookers import Onlookers
from rig.session.observer import Observer


class Heard(Observer):
    """Keeps what it is warned of."""

    def __init__(self) -> None:
        self.told: list[str] = []

    def warned(self, text: str) -> None:
        self.told.append(text)


def test_a_warning_reaches_each() -> None:
    both = Heard(), Heard()
    Onlookers(*both).warned("the shaft carries +12.7 N·m")
    assert [one.told for one in both] == [["the shaft carries +12.7 N·m"]] * 2


def test_nothing_that_an_observer_can_be_told_is_kept_from_them() -> None:
    told = {name for name, _ in inspect.getmembers(Observer, inspect.isfunction) if not name.startswith("_")}
    assert told <= set(vars(Onlookers))
