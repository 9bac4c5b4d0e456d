"""Which waves of the output's angle are asked for: no more than the way it goes can tell apart."""

from __future__ import annotations

import dataclasses

import pytest

from rig.model.output_orders import once_or_twice
from tests.contract.test_effects import REACH


@pytest.mark.parametrize(
    ("turns", "shapes"),
    [
        (2.0, ((1.0, 1.0), (2.0, 2.0), (1.0, 5.0))),
        (0.6, ((1.0, 1.0), (2.0, 2.0), (1.0, 2.0))),
        (0.4, ((1.0, 1.0), (2.0, 2.0))),
        (0.1, ((1.0, 1.0),)),
        (0.01, ()),
    ],
)
def test_of_a_part_of_a_turn_fewer_overtones_are_asked_for(
    turns: float, shapes: tuple[tuple[float, float], ...]
) -> None:
    assert once_or_twice(dataclasses.replace(REACH, load_turns=turns)) == shapes
