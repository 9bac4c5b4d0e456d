"""A real robot joint with an encoder on each side of a strain-wave gear comes in as what it is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rig.core.errors import UsageError
from rig.runfile.importing import import_file
from rig.runfile.run import Run

pytestmark = pytest.mark.xdist_group("lara8")  # what the module makes is made once, not for every worker

EXTRACT = Path(__file__).parents[2] / "data" / "lara8" / "validate_joint3.csv"
ARCMIN = 180 * 60 / np.pi


@pytest.fixture(scope="module")
def joint3(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return Run.open(import_file(EXTRACT, "lara8-joint3", tmp_path_factory.mktemp("runs")))


def test_the_run_has_the_channels_and_says_what_the_torque_is(joint3: Run) -> None:
    wanted = {"t", "theta_m", "theta_l", "tau_l", "counts_m", "counts_l"}
    assert wanted < set(joint3.channels)
    assert "tau_m" not in joint3.channels, "the current's torque is on the joint's side: it is not a motor torque"
    assert "no shaft sensor" in joint3.meaning("tau_l")
    assert "joint's side" in joint3.meaning("tau_current")
    assert joint3.rows == 1832
    assert joint3.manifest["encoders"] == {"motor_counts_per_rev": 2**24, "load_counts_per_rev": 2**24}


def test_the_angles_follow_each_other_and_the_controller_agrees(joint3: Run) -> None:
    theta_m, theta_l = joint3.need("theta_m"), joint3.need("theta_l")
    assert np.degrees(np.ptp(theta_l)) == pytest.approx(297.98, abs=0.01)
    assert np.polyfit(theta_l, theta_m, 1)[0] == pytest.approx(100.898, abs=0.001)
    wind_up = theta_m / 101 - theta_l
    assert np.ptp(wind_up) * ARCMIN == pytest.approx(18.284, abs=0.005)
    assert np.abs(wind_up).max() < 2 * np.pi / 101 / 2, "less than half a motor turn: the 59 turns are the right ones"
    assert np.std(joint3.need("joint_angle") - theta_l) < 3e-6


def test_wind_up_against_torque_is_a_stiffness_of_36_kilonewtonmetres(joint3: Run) -> None:
    wind_up = joint3.need("theta_m") / 101 - joint3.need("theta_l")
    assert 1 / np.polyfit(joint3.need("tau_l"), wind_up, 1)[0] == pytest.approx(36.3e3, abs=0.2e3)


def test_time_is_from_zero_with_its_jitter_noted_and_no_date(joint3: Run) -> None:
    t = joint3.need("t")
    assert t[0] == 0.0
    assert t[-1] == pytest.approx(7.3515272670, abs=1e-9)
    assert "sample period 3.999 ms median, 0.2557 ms least, 8.625 ms most" in joint3.manifest["notes"]
    assert "started_utc" not in joint3.manifest, "the controller's uptime is no date"


def test_the_mapping_of_another_joint_names_the_column_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="has no column 'encoder_motorinc_1'; did you mean 'encoder_motorinc_3'"):
        import_file(EXTRACT, "lara8-joint1", tmp_path / "runs")


@pytest.mark.parametrize(("joint", "file", "ratio", "travel_deg"), [
    (1, "jogging_linear_mass", 120.92, 20.5),
    (1, "jogging_final", 120.97, 7.8),
    (2, "jogging_joint_mass", 120.93, 22.9),
    (3, "validate", 100.90, 298.0),
    (6, "jogging_linear_mass", 101.03, 20.5),
])  # fmt: skip
def test_joints_of_the_whole_files(
    shared: Path, tmp_path: Path, joint: int, file: str, ratio: float, travel_deg: float
) -> None:
    source = shared / "data" / "lara8" / f"{file}.csv"
    run = Run.open(import_file(source, f"lara8-joint{joint}", tmp_path / "runs"))
    theta_m, theta_l = run.need("theta_m"), run.need("theta_l")
    assert np.degrees(np.ptp(theta_l)) == pytest.approx(travel_deg, abs=0.06)
    assert np.polyfit(theta_l, theta_m, 1)[0] == pytest.approx(ratio, abs=0.01)
    assert np.polyfit(run.need("joint_angle"), theta_l, 1)[0] == pytest.approx(1.0, abs=1e-3)
