"""The run at constant torque: one torque for all of the measured part, near the speed asked for, at rest afterwards."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.motion.source import motion_of
from rig.analysis.motion.window import measured_window
from rig.core.errors import NotReady, UsageError
from rig.procedures.constant_torque import ConstantTorque
from rig.procedures.open_loop import Found
from rig.procedures.sentinel import Sentinel
from tests.analysis.recorded import Rig, Taken

RPM = np.pi / 30


def taken(**parameters: float) -> Taken:
    return Rig().run(ConstantTorque(revolutions=12, settle=2.0, **parameters))  # type: ignore[arg-type]


@pytest.mark.slow
@pytest.mark.parametrize("speed_rpm", [pytest.param(120.0, marks=pytest.mark.slow), -310.0, 500.0])
def test_it_measures_under_one_torque_near_the_speed_and_comes_to_rest(speed_rpm: float) -> None:
    done = taken(speed_rpm=speed_rpm)
    found, columns = done.ending.finding, done.run.columns
    assert isinstance(found, Found)
    assert found.revolutions == 12
    assert found.speed_rpm == pytest.approx(speed_rpm, rel=0.08)  # the drive's torque step alone is 9 rpm
    inside = (columns["t"] >= found.begin) & (columns["t"] <= found.end)
    assert np.ptp(columns["tau_ask"][inside]) == 0.0
    assert np.isnan(columns["theta_ref"][inside]).all()
    assert abs(columns["omega_m"][-1]) < 0.1
    assert columns["tau_applied"][-1] == 0.0


@pytest.mark.slow
def test_the_measured_part_is_found_again_from_the_rows() -> None:
    done = taken(speed_rpm=300.0)
    motion = motion_of(done.run)
    assert motion is not None
    assert motion.t is not None
    window = measured_window(done.run, motion)
    assert motion.t[window.lo] == pytest.approx(done.ending.finding.begin, abs=0.003)
    assert motion.t[window.hi - 1] == pytest.approx(done.ending.finding.end, abs=0.003)
    assert window.torque == pytest.approx(done.ending.finding.torque)


@pytest.mark.slow
def test_a_torque_that_is_given_is_the_torque_that_is_commanded() -> None:
    done = taken(speed_rpm=310.0, torque=0.435)
    assert done.ending.finding.torque == 0.435
    assert "0.4350 N·m" in done.ending.finding.sentence


def test_a_torque_too_small_to_keep_the_motor_turning_is_told_and_leaves_no_torque() -> None:
    rig = Rig()
    with pytest.raises(NotReady, match=r"did not keep turning at a constant 0\.3300 N·m"):
        rig.run(ConstantTorque(speed_rpm=310.0, torque=0.33, revolutions=12, settle=1.0))
    rig.world.wait_until(rig.world.now() + 1.0)
    assert rig.world.truth().omega_m == 0.0


def test_a_torque_below_the_declared_friction_is_refused_before_anything_turns() -> None:
    rig = Rig()
    before = rig.world.truth().theta_m
    with pytest.raises(NotReady, match=r"torque = -0\.1 N·m lets .* takes 0\.32 N·m; expected more than that"):
        rig.run(ConstantTorque(speed_rpm=-310.0, torque=-0.1, revolutions=12, settle=1.0))
    assert rig.world.truth().theta_m == before


@pytest.mark.parametrize("kind", [ConstantTorque, Sentinel])
def test_no_speed_and_a_torque_against_the_speed_are_refused(kind: type[ConstantTorque] | type[Sentinel]) -> None:
    with pytest.raises(UsageError, match="speed_rpm = 0"):
        kind(speed_rpm=0.0)
    with pytest.raises(UsageError, match="expected the sign of the speed"):
        kind(speed_rpm=-300.0, torque=0.4)


def test_a_drift_is_said_in_the_finding() -> None:
    assert "drifted by +9.0 %" in Found(0.4, 1.0, 2.0, 10, 300.0, 0.09).sentence
    assert "drift" not in Found(0.4, 1.0, 2.0, 10, 300.0, 0.01).sentence
