"""A sensor that speaks at 100 lines a second, read a thousand times: said with what is not seen for it."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.analyse import analyse
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
