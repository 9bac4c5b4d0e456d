"""Whoever looks on is told of everything, several or one."""

from __future__ import annotations

from rig.commands.show.onlookers import Onlookers
from rig.session.observer import Observer


def test_whatever_an_observer_is_told_each_of_several_is() -> None:
    told = {name for name in vars(Observer) if not name.startswith("_")}
    assert told <= vars(Onlookers).keys()
