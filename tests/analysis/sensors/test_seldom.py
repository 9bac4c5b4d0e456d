"""A sensor that speaks at 100 lines a second, read a thousand times: said with what is not seen for it."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.analyse import analyse
from rig.analysis.sensors.seldom import seldom_by_value
from rig.core.channels import Flag
from tests.analysis.synthetic import PROFILE, MadeRun


@pytest.mark.parametrize(("every", "told"), [(10, True), (1, False)])
def test_a_shaft_torque_that_is_held_between_lines_is_said(every: int, told: bool) -> None:
    t = np.arange(0.0, 20.0, 1e-3)
    flags = np.where(np.arange(t.size) % every, int(Flag.STALE_TAU), 0)
    theta_m = 3.0 * t + 1e-4 * np.random.default_rng(1).standard_normal(t.size)
    theta_l = 3.0 * t / 50 - PROFILE.value(3.0 * t)
    columns = {"t": t, "theta_m": theta_m, "theta_l": theta_l, "tau_l": 0.1 * np.sin(t), "flags": flags}
    said = [one for one in analyse(MadeRun(columns)).cannot if "held between them" in one]
    assert bool(said) is told
    if told:
        assert "new in 2000 of 20000 rows, 100 times a second" in said[0]
        assert "above 50 Hz is not seen" in said[0]


def _shaft_torque(noise: float) -> tuple[np.ndarray, np.ndarray]:
    t = np.arange(0.0, 20.0, 1 / 250)
    return t, 5.0 * np.sin(t) + noise * np.random.default_rng(2).standard_normal(t.size)


def test_of_a_foreign_run_the_readings_themselves_tell_that_they_are_held() -> None:
    """A historian that stores a value when it is 0.2 N.m from the last one (exam 104, case 16): no flags, 2 % new."""
    t, torque = _shaft_torque(noise=0.01)
    stored, last = torque.copy(), torque[0]
    for i, value in enumerate(torque):
        last = value if abs(value - last) > 0.2 else last
        stored[i] = last
    said = seldom_by_value(t, stored)
    assert f"new in {1 + np.count_nonzero(np.diff(stored))} of 5000 rows" in said


def test_a_coarse_sensor_and_one_that_is_read_every_row_are_not_called_held() -> None:
    t, torque = _shaft_torque(noise=0.01)
    assert seldom_by_value(t, torque) == ""
    assert seldom_by_value(t, np.round(torque, 1)) == ""  # the same for several rows, and then one count more
    assert seldom_by_value(t, np.full(t.size, 3.0)) == ""
    assert seldom_by_value(t, None) == ""
