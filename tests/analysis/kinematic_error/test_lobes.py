"""Two lobes make order 2: where it is another one, an angle may read a part or a multiple."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.kinematic_error.lobes import may_read_twice, reads_a_part

GEAR = np.array([4.3, 39.6, 2.2, 9.4, 1.1, 4.0, 0.7, 2.2, 0.4, 1.3, 0.3, 0.8, 0.3, 0.5, 0.2])  # arcsec, orders 1 to 15


def read(times: int) -> np.ndarray:
    """Amplitudes of orders 1 to 15 where both angles read 1/`times` of what they should."""
    out = np.full(15, 0.02)
    for order, size in enumerate(GEAR, 1):
        if order * times <= out.size:
            out[order * times - 1] = size
    return out


@pytest.mark.parametrize("times", [2, 4])
def test_angles_that_read_a_half_or_a_quarter_are_told_by_their_orders(times: int) -> None:
    assert f"both angles seem to read 1/{times} of what they should" in reads_a_part(read(times))


def test_a_gear_is_a_gear_and_one_with_a_large_order_4_too() -> None:
    assert reads_a_part(GEAR) == may_read_twice(GEAR) == ""
    large = GEAR.copy()
    large[3] = 130.0
    large[0] = 20.0
    assert reads_a_part(large) == ""
    assert reads_a_part(GEAR[:3]) == reads_a_part(GEAR[:1]) == may_read_twice(GEAR[:1]) == ""


def test_a_large_order_1_is_an_encoder_or_angles_that_read_twice() -> None:
    eccentric = GEAR.copy()
    eccentric[0] = 140.0
    assert "an eccentric encoder of the motor, or both angles read twice" in may_read_twice(eccentric)
    assert reads_a_part(eccentric) == ""
