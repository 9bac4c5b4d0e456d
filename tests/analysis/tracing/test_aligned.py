"""A torque sensor that is read through a low-pass of its own is brought forward, told, and no missing effect."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.aligned import aligned
from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.fit.parameters import baseline
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.runs.late import earlier
from rig.analysis.tracing.trace import trace
from tests.analysis.tracing.spiked import Columns, change

CORNER = 240.0  # Hz
DELAY = np.sqrt(2.0) / (2 * np.pi * CORNER)  # s, of a low-pass of the second order far below its corner
RUNS = ("slow_ke_1", "slow_ke_2", "load_20nm_1", "load_20nm_2", "speed_120rpm_1", "speed_300rpm_1", "speed_300rpm_2")


def filtered(c: Columns, began: float) -> Columns:
    """The shaft torque through an analogue Butterworth low-pass, whose corner is beyond what rows 4 ms apart hold."""
    dt, torque = float(np.median(np.diff(c["t"]))), c["tau_l"]
    there_and_back = np.concatenate([torque, torque[::-1]])  # no jump where it begins again
    x = 1j * np.fft.rfftfreq(there_and_back.size, dt) / CORNER
    through = np.fft.irfft(np.fft.rfft(there_and_back) / (x**2 + np.sqrt(2) * x + 1), there_and_back.size)
    return {"tau_l": through[: torque.size]}


def early(c: Columns, began: float) -> Columns:
    """The load angle read 1 ms early, which looks the same beside the load."""
    return {"theta_l": np.interp(c["t"] + 1e-3, c["t"], c["theta_l"])}


@pytest.mark.parametrize("rows", [0.0, 0.3, 1.0, 2.7, -1.4])
def test_a_signal_is_brought_forward_by_parts_of_a_row(rows: float) -> None:
    at = np.arange(400.0)
    wave = np.sin(2 * np.pi * at / 10)
    assert earlier(wave, rows)[5:-5] == pytest.approx(np.sin(2 * np.pi * (at + rows) / 10)[5:-5], abs=6e-3)


def test_a_missing_row_spoils_its_neighbours_alone() -> None:
    x = np.ones(100)
    x[50] = np.nan
    assert np.flatnonzero(~np.isfinite(earlier(x, 1.5))).tolist() == [47, 48, 49, 50]


@pytest.mark.slow
@pytest.mark.long
def test_the_delay_of_a_low_pass_is_found_told_and_no_effect(tmp_path: Path, shared: Path) -> None:
    found = trace(change(tmp_path / "filtered", shared / "cases" / "open-1", filtered, RUNS))
    lag = next(p for p in found.baseline if p.name == "lag")
    assert lag.value == pytest.approx(DELAY, rel=0.06)
    assert found.verdict.status is Status.NOTHING
    (note,) = [note for note in found.notes if "The torque sensor is read" in note]
    assert " ms after the angles in all runs, as much as a low-pass of " in note


@pytest.mark.slow
@pytest.mark.parametrize("changed", [pytest.param(early, marks=pytest.mark.long), lambda c, began: {}])
def test_a_load_angle_that_is_early_and_a_torque_that_is_not_late_are_left_as_they_are(
    changed: object, tmp_path: Path, shared: Path
) -> None:
    campaign = read_campaign(change(tmp_path / "other", shared / "cases" / "open-1", changed, RUNS))  # type: ignore[arg-type]
    read, p = aligned(campaign, ())
    assert read is campaign
    assert p.campaign.runs[0].look.late_torque == 0.0
    assert next(q for q in baseline(p.baseline) if q.name == "lag").value < 1.1e-3


def test_a_torque_that_is_later_than_a_sensor_makes_it_is_left_to_be_named(tmp_path: Path, shared: Path) -> None:
    def much_later(c: Columns, began: float) -> Columns:
        return {"tau_l": np.interp(c["t"] - 5e-3, c["t"], c["tau_l"])}

    campaign = read_campaign(change(tmp_path / "later", shared / "cases" / "open-1", much_later, RUNS))
    read, p = aligned(campaign, ())
    assert read is campaign
    assert p.campaign.runs[0].look.late_torque == 0.0


LATE = 0.28e-3  # s
MORE = (*RUNS, "speed_60rpm_1", "speed_60rpm_2", "speed_200rpm_1", "speed_minus400rpm_1")


def teeth_and_a_late_torque(c: Columns, began: float) -> Columns:
    """Teeth that both the angles and the motor's torque feel, and a shaft torque that is read a little late."""
    waves, torque = 102 * c["theta_m"] + 0.4, np.interp(c["t"] - LATE, c["t"], c["tau_l"])
    lever = 5e-6 * 102 * np.sin(waves) * torque
    return {"theta_l": c["theta_l"] - 5e-6 * np.cos(waves), "tau_l": torque, "tau_m": c["tau_m"] + lever}


@pytest.mark.slow
@pytest.mark.long
def test_a_torque_sensor_that_is_a_little_late_is_no_missing_effect_beside_another(
    tmp_path: Path, shared: Path
) -> None:
    campaign = change(tmp_path / "teeth", shared / "cases" / "open-1", teeth_and_a_late_torque, MORE)
    found = trace(campaign)
    assert found.verdict.effects == ("tooth_mesh_error",)
    assert next(p for p in found.baseline_after if p.name == "lag").value == pytest.approx(LATE, rel=0.1)
