"""Fewer rows that hide no peak."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from rig.core.ring import NO_COUNTS
from rig.live.envelope import envelope

LAYOUT = np.dtype([("t", "f8"), ("tau_l", "f8"), ("counts_l", "i8"), ("flags", "i8")])


def rows(tau_l: list[float], counts: list[int] | None = None, flags: list[int] | None = None) -> np.ndarray[Any, Any]:
    """A block at 1 kHz with this torque [N·m]."""
    block = np.zeros(len(tau_l), LAYOUT)
    block["t"], block["tau_l"] = np.arange(len(tau_l)) * 1e-3, tau_l
    block["counts_l"], block["flags"] = counts or 0, flags or 0
    return block


def test_a_single_peak_among_many_rows_keeps_its_full_height_and_its_place() -> None:
    tau = [0.0] * 100
    tau[37], tau[41] = -8.0, 12.0
    shown = envelope(rows(tau), 10)
    assert len(shown) == 20
    assert list(shown["tau_l"][6:10]) == [0.0, -8.0, 0.0, 12.0]


def test_the_order_of_the_two_extremes_is_that_in_time() -> None:
    assert list(envelope(rows([0, 5, -5, 0]), 4)["tau_l"]) == [5, -5]
    assert list(envelope(rows([0, -5, 5, 0]), 4)["tau_l"]) == [-5, 5]


def test_a_peak_beside_a_gap_is_kept_and_a_gap_is_never_drawn_over() -> None:
    nan = float("nan")
    assert list(envelope(rows([nan, 7.0, nan, 1.0]), 4)["tau_l"]) == [7.0, 1.0]
    assert np.isnan(envelope(rows([nan] * 4), 4)["tau_l"]).all()


def test_counts_that_were_not_measured_are_no_extreme() -> None:
    assert list(envelope(rows([0.0] * 4, [NO_COUNTS, 3, 9, NO_COUNTS]), 4)["counts_l"]) == [3, 9]
    assert list(envelope(rows([0.0] * 4, [NO_COUNTS] * 4), 4)["counts_l"]) == [NO_COUNTS] * 2


def test_a_quality_bit_of_one_row_is_seen_in_both() -> None:
    assert list(envelope(rows([0.0] * 4, flags=[0, 4, 1, 0]), 4)["flags"]) == [5, 5]


def test_nothing_to_gain_leaves_the_block_as_it_is() -> None:
    block = rows([1.0, 2.0, 3.0])
    assert envelope(block, 2) is block
    assert len(envelope(block[:0], 50)) == 0


@given(st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=90), st.integers(3, 20))
def test_every_group_shows_its_own_extremes_and_time_never_runs_back(tau: list[float], every: int) -> None:
    block = rows(tau)
    shown = envelope(block, every)
    for i in range(0, len(tau), every):
        pair = shown[2 * (i // every) :][:2]
        assert sorted(pair["tau_l"]) == [min(tau[i : i + every]), max(tau[i : i + every])]
        assert pair["t"][0] == block["t"][i]
    assert (np.diff(shown["t"]) >= 0).all()
    assert shown["t"][-1] == block["t"][-1]
