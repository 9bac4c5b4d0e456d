"""Gains of a torque sensor and of a motor drift: under the torques of a lock test that is no effect."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.fit.channels import INDEX
from rig.analysis.tracing.fit.model import design, fit
from rig.analysis.tracing.fit.rows import rows
from rig.analysis.tracing.floor.held_out import HeldOut
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.runs.record import record
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.thresholds import ALONE
from rig.runfile.run import Run
from tests.analysis.tracing.spiked import Columns, spiked


def of(shared: Path, name: str) -> Recording:
    found = record(Run.open(shared / "cases" / "open-1" / name), 0.0)
    assert found is not None
    return found


@pytest.mark.slow
def test_what_the_motor_torque_of_a_lock_test_leaves_along_the_shaft_torque_is_its_own(shared: Path) -> None:
    locked, free = of(shared, "lock_60_1"), of(shared, "load_20nm_1")
    own = rows(locked, "M").own
    torque = np.concatenate([locked.smoother(p.tau_l) for p in locked.pieces])[rows(locked, "M").keep]
    np.testing.assert_allclose(own[:, 0], torque)
    assert rows(free, "M").own.shape[1] == rows(locked, "A").own.shape[1] == 0


@pytest.mark.slow
@pytest.mark.long
def test_a_motor_whose_torque_constant_is_off_in_lock_tests_leaves_the_kinematic_error_as_it_is(shared: Path) -> None:
    campaign = read_campaign(shared / "cases" / "open-1")

    def orders(runs: tuple[Recording, ...]) -> Any:
        p = prepare(replace(campaign, runs=runs), ())
        x = fit(design(p.eq, (), p.split.fitted)).x
        return x[[INDEX[f"{c}{n}"] for n in range(1, 7) for c in "ab"]]

    def weaker(run: Recording) -> Recording:
        if not run.locked:
            return run
        return replace(run, pieces=tuple(replace(p, tau_m=0.99 * p.tau_m) for p in run.pieces))

    np.testing.assert_allclose(orders(tuple(map(weaker, campaign.runs))), orders(campaign.runs), atol=3e-7)


@pytest.mark.parametrize(("share", "left"), [(0.5, 0.0), (3.0, 2.0), (-3.0, -2.0)])
def test_of_what_is_left_along_the_torque_of_a_lock_test_a_gains_tolerance_is_taken_off(
    share: float, left: float
) -> None:
    torque, gain = np.linspace(-60.0, 60.0, 601), 1e-7
    loop = 4e-6 * np.sign(np.cos(np.arange(601)))
    loop -= torque * (torque @ loop) / (torque @ torque)
    part = SimplePart(torque)
    d: Any = Designed({(0, "A"): loop + share * gain * torque}, {(0, "A"): (part,)})
    at = HeldOut((0,), {(0, "A"): 4e-6}, {}, {(0, "A"): 1.0}, {(0, "A"): gain})
    solution: Any = type("S", (), {"x": np.zeros(1)})
    e = at.residuals(solution, d)[0, "A"]
    np.testing.assert_allclose(e, loop + left * gain * torque, atol=1e-15)


@pytest.mark.parametrize(("rows", "over", "loud"), [(15, 1.45, False), (15, 1.7, True), (500, 1.35, True)])
def test_a_few_rows_may_be_as_far_over_the_floor_as_chance_brings_them(rows: int, over: float, loud: bool) -> None:
    at = HeldOut((0,), {(0, "R"): 1.0}, {}, {(0, "R"): 1.2}, {})
    e = {(0, "R"): np.full(rows, over)}
    assert at.loud(e, 1.5, named=False) is loud
    assert at.worst(e)[0] == pytest.approx(over), "what is told is what is left"


@pytest.mark.parametrize(("lenient", "over", "loud"), [(1.2, 2.3, True), (1.5, 2.3, False), (1.5, 3.2, True)])
def test_reversals_of_one_run_that_no_repeats_tell_of_are_judged_as_that_run(
    lenient: float, over: float, loud: bool
) -> None:
    at = HeldOut((0,), {(0, "R"): 1.0, (0, "M"): 1.0}, {}, {(0, "R"): lenient, (0, "M"): 1.0}, {})
    e = {(0, "R"): np.full(500, over), (0, "M"): np.ones(500)}
    assert at.loud(e, ALONE, named=False) is loud


class SimplePart:
    """As much of a design's part as is asked."""

    def __init__(self, torque: np.ndarray[Any, Any]) -> None:
        self.at = np.array([INDEX["compliance"]])
        self.z: Any = type("Z", (), {"times": lambda _, c: torque * c[0]})()


class Designed:
    """As much of a design as is asked."""

    def __init__(self, y: dict[Any, Any], parts: dict[Any, Any]) -> None:
        self.y, self.parts = y, parts

    def residual(self, key: Any, x: Any) -> Any:
        return self.y[key]


SOME = ("slow_ke_1", "slow_ke_2", "load_5nm_1", "load_5nm_2", "load_20nm_1", "load_20nm_2", "load_40nm_1",
        "load_40nm_2", "speed_200rpm_1", "speed_200rpm_2", "speed_400rpm_1", "speed_minus200rpm_1")  # fmt: skip


@pytest.mark.slow
@pytest.mark.long
def test_a_torque_constant_that_is_off_is_a_gain_and_no_missing_effect(shared: Path, tmp_path: Path) -> None:
    def weaker(c: Columns, began: float) -> Columns:
        return {"tau_m": 0.96 * c["tau_m"]}

    found = spiked(tmp_path, shared / "cases" / "open-1", weaker, SOME)
    assert (found.verdict.status, found.verdict.effects) == (Status.NOTHING, ())
    gain = next(p for p in found.baseline if p.name == "gain")
    assert gain.value == pytest.approx(-0.04, abs=2e-3)
    assert gain.ci95[0] < -0.04 < gain.ci95[1]
    assert any("differ by a gain" in said for said in found.cannot)
