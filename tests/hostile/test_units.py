"""Campaigns in another unit or ratio than declared: refused in a sentence when most runs show it, else by run."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit import scale
from rig.analysis.tracing.fit.channels import BASELINE, INDEX
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.core.errors import UsageError
from tests.hostile.test_campaigns import Columns, campaign, times

COUNTS = 65536


def counted(c: Columns) -> Columns:
    """With a motor angle in whole counts."""
    count = 2 * np.pi / COUNTS
    return {**c, "theta_m": np.round(c["theta_m"] / count) * count}


def degrees(c: Columns) -> Columns:
    return {**c, "theta_m": np.degrees(c["theta_m"]), "theta_l": np.degrees(c["theta_l"])}


def held(c: Columns) -> Columns:
    """With an output that gives way by a few hundredths of a degree, however far the motor goes."""
    return {**c, "theta_l": 5e-4 * np.sin(c["theta_m"])}


def longer(c: Columns) -> Columns:
    """Five times as far, 63 turns of the motor: enough to show a ratio 2 % off."""
    return {**c, "theta_m": 5 * c["theta_m"], "theta_l": 5 * c["theta_l"]}


@pytest.mark.parametrize(
    ("change", "said", "expected"),
    [
        (
            lambda c: degrees(counted(c)),
            {"encoders": {"motor_counts_per_rev": COUNTS}},
            "θ_m moves in steps of 0.005493 rad, 57.3 times the declared count of 9.59e-05 rad",
        ),
        (degrees, {"conditions": {"speed_rpm": 75.6}}, "57.3 times the declared speed_rpm 75.6"),
        (lambda c: degrees(longer(c)), {}, "the motor turns at 2.166e+04 rpm, expected below 15000 rpm"),
        (times("theta_m", 180 / np.pi), {}, "θ_m seems to be in degrees, expected rad"),
        (times("theta_l", 180 / np.pi), {}, "θ_l seems to be in degrees, expected rad"),
        (times("theta_l", -1.0), {}, "θ_l goes -1 of θ_m/50, expected 1: one of the angles has the other sign"),
        (times("theta_l", 0.0), {}, "θ_l does not move"),
        (lambda c: c, {"gear": {"ratio": 80}}, "θ_m/θ_l is 50, the declared gear.ratio 80"),
        (longer, {"gear": {"ratio": 51}}, "θ_m/θ_l is 50, the declared gear.ratio 51"),
    ],
    ids=["steps", "speed", "too fast", "motor", "load", "sign", "frozen", "ratio", "ratio of the other member"],
)
def test_a_campaign_in_another_unit_or_ratio_is_refused_with_numbers(
    tmp_path: Path, change: Callable[[Columns], Columns], said: dict[str, Any], expected: str
) -> None:
    with pytest.raises(UsageError) as caught:
        read_campaign(campaign(tmp_path, change, 3, **said))
    assert str(caught.value).startswith(f"{tmp_path.name}: in 3 of 3 runs that turn (here run-0) ")
    assert expected in str(caught.value)


def test_one_run_in_degrees_is_left_out_by_name(tmp_path: Path) -> None:
    said = {"conditions": {"speed_rpm": 75.6}}
    campaign(tmp_path, lambda c: c, 3, **said)
    campaign(tmp_path / "more", degrees, 1, **said)
    shutil.move(tmp_path / "more" / "run-0", tmp_path / "odd")
    found = read_campaign(tmp_path)
    assert [run.name for run in found.runs] == ["run-0", "run-1", "run-2"]
    assert any(note.startswith("odd was left out: the motor turns at") for note in found.notes)


@pytest.mark.parametrize(
    ("also", "said"),
    [
        ({"theta_l"}, "comes again once in 57.3 turns of θ_m as it stands"),
        (set(), "57.3 times the 75.6 rpm of run-0 and 2 more: both angles"),
    ],
    ids=["both angles", "the motor's alone"],
)
def test_one_run_in_degrees_among_alike_ones_is_left_out_though_nobody_says_speed_or_counts(
    tmp_path: Path, also: set[str], said: str
) -> None:
    def some(c: Columns) -> Columns:
        return {n: x for n, x in c.items() if n != "theta_l" or n in also}

    campaign(tmp_path, some, 3)
    campaign(tmp_path / "more", lambda c: some(degrees(c)), 1)
    shutil.move(tmp_path / "more" / "run-0", tmp_path / "odd")
    found = read_campaign(tmp_path)
    assert [run.name for run in found.runs] == ["run-0", "run-1", "run-2"]
    assert any(said in note for note in found.notes)


def test_a_faster_run_is_in_degrees_only_where_it_is_57_times_as_fast_as_alike_ones(tmp_path: Path) -> None:
    campaign(tmp_path, lambda c: c, 3)
    campaign(tmp_path / "more", lambda c: {**c, "theta_m": 40 * c["theta_m"], "theta_l": 40 * c["theta_l"]}, 1)
    shutil.move(tmp_path / "more" / "run-0", tmp_path / "fast")
    assert len(read_campaign(tmp_path).runs) == 4


def test_slow_runs_of_the_encoder_of_a_fast_one_in_degrees_are_in_degrees_too(tmp_path: Path) -> None:
    def alone(c: Columns) -> Columns:
        return {n: x for n, x in degrees(counted(c)).items() if n != "theta_l"}  # both angles tell it by their waves

    campaign(tmp_path, alone, 3)
    assert len(read_campaign(tmp_path).runs) == 3, "by themselves they may turn as slowly as they say"
    campaign(tmp_path / "more", lambda c: alone(longer(c)), 1)
    shutil.move(tmp_path / "more" / "run-0", tmp_path / "fast")
    with pytest.raises(UsageError, match=r"in 4 of 4 runs that turn .*its angle seems to be in degrees"):
        read_campaign(tmp_path)


@pytest.mark.parametrize("factor", [1e6, 1e-5], ids=["microseconds", "days"])
def test_a_time_in_another_unit_is_refused_and_not_left_unused(tmp_path: Path, factor: float) -> None:
    with pytest.raises(UsageError, match=r"t says .* s between rows, expected 1e-07 to 60 s"):
        read_campaign(campaign(tmp_path, times("t", factor)))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda c: {n: x for n, x in c.items() if n != "theta_l"}, {"gear": {"ratio": 80}}),
        (lambda c: {n: x for n, x in c.items() if n != "theta_m"}, {"gear": {"ratio": 80}}),
        (degrees, {"procedure": "standstill"}),
        (held, {"conditions": {"output_locked": True}}),
        (lambda c: {**c, "theta_l": c["theta_l"] + 5e-3 * np.sin(c["theta_m"] / 25)}, {}),
        (lambda c: c, {"conditions": {"speed_rpm": 75.6 / 50}}),
        (lambda c: c, {"gear": {"ratio": 50.4}}),
    ],
    ids=["motor only", "load only", "standstill", "locked", "wind-up", "speed of the output", "a ratio 0.8 % off"],
)
def test_what_may_be_right_is_not_refused(
    tmp_path: Path, change: Callable[[Columns], Columns], said: dict[str, Any]
) -> None:
    assert len(read_campaign(campaign(tmp_path, change, **said)).runs) == 2


def fitted(compliance: float, J_m: float, J_l: float) -> Any:
    """A solution with these coefficients, and runs that declare the paper's gear."""
    run = SimpleNamespace(declared={"K": 7160.0, "J_m": 1.5e-3, "J_l": 0.8})
    values = {"compliance": compliance, "J_m": J_m, "J_l": J_l}
    return SimpleNamespace(value=values.__getitem__, design=SimpleNamespace(eq=SimpleNamespace(runs=(run, run))))


@pytest.fixture
def _known(monkeypatch: pytest.MonkeyPatch) -> None:
    spread = np.zeros(len(BASELINE))
    spread[INDEX["J_l"]] = 1.0  # kg·m², squared: not known at all
    monkeypatch.setattr(scale, "scatter", lambda s: np.diag(spread))


@pytest.mark.usefixtures("_known")
def test_a_gear_as_declared_is_worth_no_word_nor_is_what_is_not_known() -> None:
    assert scale.off_scale(fitted(1 / 7000, 1.4e-3, 1.0), "c") == ()
    assert scale.off_scale(fitted(1 / 7000, 1.4e-3, 4.0), "c") == ()


@pytest.mark.usefixtures("_known")
def test_one_number_far_from_its_declaration_is_a_note() -> None:
    (note,) = scale.off_scale(fitted(1 / 7.16e6, 1.4e-3, 0.8), "c")
    assert note.startswith("K comes out as 7.16e+06 N·m/rad, 1e+03 times the 7.16e+03 declared")


@pytest.mark.usefixtures("_known")
def test_two_numbers_off_by_the_factor_of_a_unit_are_refused() -> None:
    with pytest.raises(UsageError, match=r"c: K comes out as .* torques seem to be in mN·m, expected N·m"):
        scale.off_scale(fitted(1 / 7.0e6, 1.4, 0.8), "c")
    with pytest.raises(UsageError, match="angles seem to be in degrees, expected rad"):
        scale.off_scale(fitted(57.3 / 7160, 1.5e-3 / 57.3, 0.8), "c")
