"""Lock tests that want a torque constant each are told of, where loaded runs repeat theirs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.residual import gains_of_locks as module
from rig.analysis.tracing.residual.gains_of_locks import Gain, gains_of_locks
from tests.analysis.tracing.spiked import Columns, spiked

SOME = ("slow_ke_1", "slow_ke_2", "load_20nm_1", "load_20nm_2", "load_40nm_1", "load_40nm_2", "speed_200rpm_1",
        "speed_200rpm_2", "speed_400rpm_1", "speed_minus200rpm_1", "lock_60_1", "lock_60_2")  # fmt: skip


@pytest.mark.parametrize(
    ("values", "half", "repeated", "told"),
    [
        ((0.0088, 0.0104), 1e-4, [3e-4, 1e-4], True),
        ((0.0088, 0.0090), 1e-4, [1e-4], False),  # they agree
        ((0.0088, 0.0104), 4e-4, [1e-4], False),  # hardly known
        ((0.0088, 0.0104), 1e-4, [1e-3], False),  # a gain that wanders
        ((0.0088, 0.0104), 1e-4, [], False),  # nobody knows whether it does
        ((0.0088,), 1e-4, [1e-4], False),
    ],
)
def test_gains_that_differ_by_more_than_loaded_repeats_are_told(
    monkeypatch: pytest.MonkeyPatch, values: tuple[float, ...], half: float, repeated: list[float], told: bool
) -> None:
    gains = [Gain(f"lock {i}", value, half) for i, value in enumerate(values)]
    monkeypatch.setattr(module, "_gain", lambda s, run: gains[run])
    monkeypatch.setattr(module, "_of_loaded_repeats", lambda s, runs: repeated)
    nothing: Any = None
    found = gains_of_locks(nothing, range(len(values)))
    assert (found is not None) is told
    if found is not None:
        assert "by 0.880 ± 0.010 % in lock 0 and by 1.040 ± 0.010 % in lock 1" in found.sentence()


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("second", [0.006, 0.009])
def test_a_torque_constant_that_falls_between_lock_tests_is_told(shared: Path, tmp_path: Path, second: float) -> None:
    shares = iter((0.006, second))  # the runs are changed by name

    def weaker(c: Columns, began: float) -> Columns:
        locked = abs(c["tau_l"]).max() > 50.0 and float(c["theta_m"].max() - c["theta_m"].min()) < 6.0
        return {"tau_m": c["tau_m"] + next(shares) * c["tau_l"] / 50.0} if locked else {}

    found = spiked(tmp_path, shared / "cases" / "open-1", weaker, SOME)
    assert found.verdict.effects == ()
    told = found.verdict.status is Status.UNKNOWN and found.verdict.coordinate == "time"
    assert told is (second != 0.006)
