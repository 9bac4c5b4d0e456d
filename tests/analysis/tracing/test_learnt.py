"""The zero of a torque sensor is read from the load's equation where that holds."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit.channels import BASELINE
from rig.analysis.tracing.fit.learnt import learnt
from tests.contract.test_effects import KNOWN

FITTED = dict.fromkeys(BASELINE, 0.0) | {"compliance": 1e-4, "J_m": 2e-3, "J_l": 0.9, "tau_l0": 8.6}


@pytest.mark.parametrize(("left", "zero"), [(0.1, 8.6), (7.6, KNOWN.torque_zero)])
def test_a_load_that_is_another_one_from_time_to_time_tells_no_zero(left: float, zero: float) -> None:
    run = SimpleNamespace(gear=KNOWN, has={"theta_l"}, load_unread=False)
    design = SimpleNamespace(eq=SimpleNamespace(runs=(run,), noise=SimpleNamespace(sigma={"L": 0.3})))
    s: Any = SimpleNamespace(
        design=design, values=FITTED, keys=((0, "A"), (0, "L")), residual=lambda key: np.full(100, left)
    )
    known = learnt(s)
    assert known.torque_zero == zero
    assert (known.K, known.J_m) == (pytest.approx(1e4), 2e-3)


@pytest.mark.parametrize(("unread", "declared", "stiffness"), [
    (True, {"K": 4.2e4}, KNOWN.K),  # a quarter of what is declared: an arm's weight does the winding
    (True, {"K": 5e3}, 1e4),
    (True, {}, 1e4),
    (False, {"K": 4.2e4}, 1e4),  # its torque was read
])  # fmt: skip
def test_a_spring_far_from_the_declared_one_is_none_where_nobody_read_the_torque(
    unread: bool, declared: dict[str, float], stiffness: float
) -> None:
    run = SimpleNamespace(gear=KNOWN, has={"theta_l"}, load_unread=unread, declared=declared)
    design = SimpleNamespace(eq=SimpleNamespace(runs=(run,), noise=SimpleNamespace(sigma={"L": 0.3})))
    s: Any = SimpleNamespace(design=design, values=FITTED, keys=(), residual=lambda key: np.zeros(1))
    found = learnt(s).K
    assert found == pytest.approx(stiffness)
