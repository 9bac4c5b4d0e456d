"""Two angles that do not go in the declared ratio: the usual mistakes by name, and none where it is another gear."""

from __future__ import annotations

import math

import pytest

from rig.analysis.motion.mistaken import mistaken


@pytest.mark.parametrize(
    ("turns", "said"),
    [
        (0.02, "taken for each other"),
        (-50.0, "the other sign"),
        (50.0 * 180 / math.pi, "θ_m seems to be in degrees"),
        (50.0 * math.pi / 180, "θ_l seems to be in degrees"),
        (80.0, ""),
        (math.inf, ""),
        (0.0, ""),
    ],
)
def test_the_usual_mistakes_are_named(turns: float, said: str) -> None:
    found = mistaken(50.0, turns)
    assert (said in found) if said else found == ""


def test_of_a_ratio_of_one_nothing_is_taken_for_the_other() -> None:
    assert mistaken(1.0, 1.0) == ""
