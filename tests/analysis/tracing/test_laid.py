"""Columns laid beside each other for the search."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.tracing.fit.equations import Equations, Noise
from rig.analysis.tracing.fit.laid import Block, Sheet

KEY = (0, "M")


def sheet(room: int) -> Sheet:
    """Of a run whose offset is its own, every other of six rows."""
    eq = Equations((), {}, Noise({"M": 1.0}, {"M": 1.0}, {"M": np.inf}))
    return Sheet(eq, KEY, np.array([0, 2, 4]), room)


def made(room: int) -> Block:
    """Two columns, none, two of nothing, one that was not measured."""
    made = sheet(room)
    made.add(np.array([[1.0, 0.0], [9.0, 9.0], [2.0, 0.0], [9.0, 9.0], [3.0, 6.0], [9.0, 9.0]]))
    made.add(None)
    made.add_zeros(2)
    made.add(np.full((6, 1), np.nan))
    block = made.block()
    assert block is not None
    return block


@pytest.mark.parametrize("room", [1, 5, 50])
def test_terms_lie_side_by_side_however_much_room_there_was(room: int) -> None:
    block = made(room)
    np.testing.assert_array_equal(block.columns[:, :2], [[-1.0, -2.0], [0.0, -2.0], [1.0, 4.0]])
    assert not block.columns[:, 2:].any()
    assert block.widths.tolist() == [2, 0, 2, 1]
    assert block.products.tolist() == [2.0, 6.0, 6.0, 24.0, *[0.0] * 5]


def test_a_channel_that_no_term_shows_in_has_no_block() -> None:
    none = sheet(4)
    none.add(None)
    assert none.block() is None
