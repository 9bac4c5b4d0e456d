"""Friction that wears off on the way: how far the motor has gone since it turned back, or set out."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from rig.analysis.tracing.nameless.wiped import SET_OUT, TURNED, WipedGrease, _gone
from rig.model.effect import Port, Signals
from tests.contract.test_effects import REACH, motion


def swung() -> Signals:
    """Six radians forth, eight back, at 1 rad/s."""
    t = np.arange(14_000) * 1e-3
    way = np.where(t < 6.0, 1.0, -1.0)
    theta = np.where(t < 6.0, t, 12.0 - t)
    return dataclasses.replace(motion(n=t.size), t=t, dt=1e-3, theta_m=theta, way=way, omega_m=way)


def test_the_way_counts_anew_where_the_motor_turns_back() -> None:
    s = swung()
    turned, set_out = _gone(s, from_the_start=False), _gone(s, from_the_start=True)
    assert np.isinf(turned[:6000]).all()
    np.testing.assert_allclose(set_out[:6000], s.t[:6000], atol=2e-3)
    for gone in (turned, set_out):
        np.testing.assert_allclose(gone[6000:], s.t[6000:] - 6.0, atol=2e-3)


@pytest.mark.parametrize("since", [TURNED, SET_OUT])
def test_it_resists_either_way_and_is_worn_off_by_what_it_is_called(since: float) -> None:
    column = WipedGrease().columns(swung(), (since, 4.0))[Port.MOTOR_TORQUE][:, 0]
    assert column[0] == pytest.approx(since, abs=1e-6)  # before the motor has turned back nothing is known of a ridge
    assert column[6000] == pytest.approx(-1.0, abs=1e-3)
    assert column[10_000] == pytest.approx(-np.exp(-1.0), abs=1e-3)


def test_a_part_of_a_piece_remembers_where_the_motor_turned_back_before_it() -> None:
    law, s = WipedGrease(), swung()
    whole = law.columns(s, (TURNED, 4.0))[Port.MOTOR_TORQUE]
    np.testing.assert_array_equal(
        law.columns(s.part(slice(9000, 12_000)), (TURNED, 4.0))[Port.MOTOR_TORQUE], whole[9000:12_000]
    )


def test_where_no_motor_turns_back_only_what_a_run_began_with_wears_off() -> None:
    shapes = WipedGrease().shapes(dataclasses.replace(REACH, backwards=0.0))
    assert {since for since, _ in shapes} == {SET_OUT}
    assert WipedGrease().shapes(dataclasses.replace(REACH, backwards=0.0, runs=1)) == ()
