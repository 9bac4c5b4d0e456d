"""What a second look may take away of what the first has named."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing.looks.reversals import _adds
from rig.analysis.tracing.selection.score import HeldOutScore

BUILT = HeldOutScore("presliding_friction", 1.0, 14.4, 0.8, 1.0, ((0, "R"),))
SMALL = HeldOutScore("stribeck_friction", 0.9, 1.0, 1.05, 1.0, ((0, "M"),))


def selected(*scores: HeldOutScore, loud: bool = False) -> Any:
    return SimpleNamespace(scores=scores, names={score.name for score in scores}, loud=loud)


@pytest.mark.parametrize(
    ("lost", "counts"),
    [
        (SMALL, True),
        (replace(SMALL, size=2.0), False),  # no tenth of it
        (replace(SMALL, ground=((0, "A"),)), False),  # in a channel that the motor's friction does not act in
    ],
)
def test_a_name_may_be_lost_in_the_motors_torque_alone_and_where_it_is_a_tenth(
    lost: HeldOutScore, counts: bool
) -> None:
    assert _adds(selected(BUILT), selected(lost)) is counts


def test_it_counts_where_it_is_named_and_leaves_no_more() -> None:
    assert not _adds(selected(SMALL), selected(SMALL))
    assert not _adds(selected(BUILT, loud=True), selected())
    assert _adds(selected(BUILT, loud=True), selected(loud=True))
