"""A skew run is refused where its analysis could only say that there is too little of it."""

from __future__ import annotations

import pytest

from rig.analysis.sensors import latch_skew, latch_skew_words
from rig.core.errors import UsageError
from rig.core.units import RPM
from rig.procedures import skew
from rig.procedures.skew import Skew


@pytest.mark.parametrize(
    ("speeds", "repeats", "words"),
    [
        (
            "40,120,300",
            1,
            "repeats = 1: 3 times forth and back with 3 speeds, expected at least 4, which is repeats = 2",
        ),
        ("40,120", 1, "repeats = 1: 2 times forth and back with 2 speeds, expected at least 4, which is repeats = 2"),
        ("40,45", 2, "speeds_rpm = 40,45: expected speeds of at least 2 rpm, the slowest and the fastest at least 10 "),
        ("1,120", 2, "speeds_rpm = 1,120: expected speeds of at least 2 rpm"),
        ("40,40", 2, "expected at least 2 different speeds in rpm"),
    ],
)
def test_one_that_could_settle_nothing_is_refused_with_what_it_takes(speeds: str, repeats: int, words: str) -> None:
    with pytest.raises(UsageError, match=words):
        Skew(speeds_rpm=speeds, repeats=repeats)


@pytest.mark.parametrize(("speeds", "repeats"), [("40,120,200,300", 1), ("40,120", 2), ("2,12", 2)])
def test_as_many_as_it_takes_are_taken(speeds: str, repeats: int) -> None:
    assert Skew(speeds_rpm=speeds, repeats=repeats).repeats == repeats


def test_it_asks_for_what_its_analysis_needs() -> None:
    assert skew.FEWEST_PAIRS == latch_skew_words.FEWEST
    assert skew.SLOWEST * RPM > latch_skew.SLOWEST
    assert skew.APART * RPM > latch_skew_words.LEVER
