"""The twin's load follows better with its own kinematic error fed forward, by as much as the model says."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.across_runs.compensation import BINS, Expected, Followed, expected, turned
from rig.analysis.findings.intervals import Ranged
from rig.bench import read, twin_parameters
from rig.closing.compensate import Compared, compensate, unlike_the_model
from rig.core.errors import NotReady
from rig.model.fourier import FourierSeries
from rig.model.gearfile import GearFile, declared
from rig.process.interrupts import Interrupts
from rig.session import Session

pytestmark = pytest.mark.xdist_group("compensate")  # what the module makes is made once, not for every worker


def gear() -> GearFile:
    return declared(twin_parameters(read("twin").file).gear, simulated=True)


def turned_gear(shift: float) -> GearFile:
    """As it was identified before the encoder's zero moved by `shift` rad."""
    known = gear()
    series = turned(known.kinematic_error.series, -shift)
    return replace(known, kinematic_error=replace(known.kinematic_error, series=series))


def made(root: Path, known: GearFile, speed: float) -> tuple[Compared, float]:
    with Session(read("twin"), "virtual", root, Interrupts()) as session:
        said: list[str] = []
        told: list[Compared] = []
        found, where = compensate(session, known, [speed], 3, said.append, told.append)
    assert told == found
    assert said[0].startswith("the motor is about to turn")
    assert any(f"{speed:g} rpm without compensation: 3 turns of the motor forth and back, " in line for line in said)
    assert not any("the load left its reference" in line for line in said)  # the figures are told once
    return found[0], where.shift


def test_turning_a_series_moves_it_along_the_angle() -> None:
    series, theta = FourierSeries((1.0, 0.3), (0.2, -0.5)), np.linspace(0, 6, 50)
    assert turned(series, 0.7).value(theta) == pytest.approx(series.value(theta - 0.7))


@pytest.fixture(scope="module")
def slow(tmp_path_factory: pytest.TempPathFactory) -> tuple[Compared, float]:
    return made(tmp_path_factory.mktemp("slow"), gear(), 9.6)


@pytest.mark.long
@pytest.mark.slow
def test_at_the_slow_speed_most_of_the_error_goes_and_the_model_says_how_much(slow: tuple[Compared, float]) -> None:
    found, _ = slow
    assert found.without.rms.value == pytest.approx(found.expected_without.rms, rel=0.03)
    assert found.improvement > 8.0
    assert found.improvement == pytest.approx(found.expected_improvement, rel=0.3)
    assert found.with_it.rms.low < found.with_it.rms.value < found.with_it.rms.high
    low, high = found.expected_with.rms_ci95
    assert low < found.expected_with.rms < high
    assert found.with_it.rms.low < high
    assert found.with_it.rms.high > low
    assert unlike_the_model(found) == []


@pytest.mark.long
@pytest.mark.slow
def test_a_zero_of_the_encoder_that_has_moved_is_found_and_one_that_has_not_is_kept(
    slow: tuple[Compared, float], tmp_path: Path
) -> None:
    # the bench declares the error by the shaft's angle; the encoder counts from where it was mounted
    assert abs(slow[1]) > 1.0
    found, shift = made(tmp_path, turned_gear(-slow[1]), 60.0)
    assert shift == 0.0
    assert found.improvement > 5.0


@pytest.mark.long
@pytest.mark.slow
def test_the_series_of_another_gear_is_refused_before_it_is_fed_forward(tmp_path: Path) -> None:
    known = gear()
    other = FourierSeries((4e-4, 0.0, 0.0), (0.0, 0.0, 1e-4))
    strange = replace(known, kinematic_error=replace(known.kinematic_error, series=other))
    with pytest.raises(NotReady, match="another gear"):
        made(tmp_path, strange, 60.0)


def told_of(gear_file: GearFile) -> tuple[Expected, Expected]:
    """What is expected at 300 rpm of a motor whose loop leaves nothing."""
    nothing = Ranged(0.0, 0.0, 0.0)
    before = Followed(nothing, nothing, np.zeros((2, BINS)), np.zeros((2, BINS)), np.zeros((8, BINS)), 8)
    return expected(gear_file, 300.0, before, np.random.default_rng(1))


def test_what_the_gear_file_does_not_know_well_the_prediction_does_not_either() -> None:
    known = gear()
    sure, _ = told_of(known)
    assert sure.rms_ci95 == pytest.approx((sure.rms, sure.rms))
    K = known.parameters["K"]
    vague = replace(K, interval=(0.8 * K.value, 1.2 * K.value))
    unsure, _ = told_of(replace(known, parameters={**known.parameters, "K": vague}))
    assert unsure.rms == sure.rms
    assert unsure.rms_ci95[0] < 0.99 * sure.rms < 1.01 * sure.rms < unsure.rms_ci95[1]


@pytest.mark.parametrize(("times", "told"), [(1.0, 0), (1.2, 0), (2.0, 1), (0.5, 1)])
def test_a_prediction_that_is_not_what_was_measured_is_said(times: float, told: int) -> None:
    without, with_it = told_of(gear())
    rms = Ranged(times * without.rms, 0.99 * times * without.rms, 1.01 * times * without.rms)
    shown: Any = SimpleNamespace(rms=rms)
    same: Any = SimpleNamespace(rms=Ranged(1.0, 0.9, 1.1))
    flat = replace(with_it, rms=1.0, rms_ci95=(0.9, 1.1))
    said = unlike_the_model(Compared(300.0, shown, same, without, flat, ("a", "b")))
    assert len(said) == told
    assert all("without compensation the error is" in one and "what the model said" in one for one in said)
