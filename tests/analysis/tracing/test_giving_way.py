"""A housing that moves under the encoder of a locked output is told by that encoder alone."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.runs.giving_way import gives_way
from rig.analysis.tracing.runs.smoothing import Smoother
from rig.model.effect import Array
from tests.analysis.tracing.spiked import Columns, spiked

COMPLIANCE = 2.0e-7  # rad/(N·m)
T = np.arange(0.0, 60.0, 0.004)


@pytest.mark.slow
@pytest.mark.long
def test_a_housing_that_moves_is_named_where_only_lock_tests_show_it(tmp_path: Path, shared: Path) -> None:
    def moving(c: Columns, began: float) -> Columns:
        turned = COMPLIANCE * c["tau_l"]
        return {"theta_l": c["theta_l"] + turned, "theta_m": c["theta_m"] + turned}

    found = spiked(tmp_path, shared / "cases" / "open-1", moving)
    assert (found.verdict.status, found.verdict.effects) == (Status.EXPLAINED, ("support_compliance",))
    (compliance,) = found.effects[0].parameters  # no frequency: nothing shows one
    assert compliance.value == pytest.approx(COMPLIANCE, rel=0.05)
    assert compliance.ci95[0] < COMPLIANCE < compliance.ci95[1]
    assert any("a lock that gives way" in sentence for sentence in found.cannot)


def lock_test(angle: Any, torque: float = 60.0) -> Any:
    """60 s of a triangle of torque; `angle` makes the load angle of it."""
    tau = torque * (2 / np.pi) * np.arcsin(np.sin(2 * np.pi * T / 20.0))
    noise = 2e-6 * np.random.default_rng(int(torque)).standard_normal(T.size)
    piece = SimpleNamespace(t=T, theta_l=angle(tau) + noise, tau_l=tau)
    smoother = Smoother(16.0, 0.004, 2)
    return SimpleNamespace(
        locked=True, input_locked=False, has={"theta_m", "theta_l", "tau_l"}, pieces=(piece,), smoother=smoother
    )


def still(tau: Array) -> Array:
    return np.zeros_like(tau)


def pressed(tau: Array) -> Array:
    return COMPLIANCE * tau


def loose(tau: Array) -> Array:
    """Play of the lock, taken up by any torque."""
    return 5e-6 * np.sign(tau)


@pytest.mark.parametrize(
    ("runs", "told"),
    [
        ([lock_test(pressed), lock_test(pressed, 20.0)], True),
        ([lock_test(pressed)], False),  # one test, nothing to hold it against
        ([lock_test(still), lock_test(still, 20.0)], False),
        (
            [lock_test(lambda tau: 0.3 * pressed(tau)), lock_test(lambda tau: 0.3 * pressed(tau), 20.0)],
            False,
        ),  # the lock
        ([lock_test(loose), lock_test(loose, 20.0)], False),
        ([lock_test(pressed), lock_test(still, 20.0)], False),
        ([lock_test(lambda tau: -pressed(tau)), lock_test(lambda tau: -pressed(tau), 20.0)], False),  # a wrong sign
    ],
)
def test_the_load_angle_has_to_go_with_the_torque_in_every_lock_test(runs: list[Any], told: bool) -> None:
    assert gives_way(runs) is told
