"""Angles in another unit than rad are named as such, and no gain is blamed for them; a gap is no high speed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rig.analysis import Verdict, analyse
from rig.core.units import DEG, TURN
from tests.analysis.synthetic import MadeRun, slow_run


def scaled(run: MadeRun, factor: float) -> MadeRun:
    """Both angles times `factor`."""
    return replace(run, columns={k: v * factor if k in ("theta_m", "theta_l") else v for k, v in run.columns.items()})


@pytest.mark.slow
@pytest.mark.parametrize(("factor", "word"), [(1 / DEG, "in deg?"), (1 / TURN, "in turns?"), (TURN, "2π twice?")])
@pytest.mark.parametrize("referenced", [True, False])
def test_a_unit_that_looks_wrong_is_said_instead_of_advice_on_gains(factor: float, word: str, referenced: bool) -> None:
    made = slow_run(1, amplitude_turns=12.0)
    rpm = 4 * 12.0 * 0.01 * 60
    columns = dict(made.columns)
    if not referenced:
        columns.pop("theta_ref", None)
    made = replace(made, columns=columns, manifest={**made.manifest, "conditions": {"speed_rpm": rpm}})
    assert analyse(made).verdict is Verdict.MEASURED
    result = analyse(scaled(made, factor))
    assert result.verdict is Verdict.INCONCLUSIVE
    assert result.sentence.startswith("The unit of theta_m looks wrong: the motor turns at ")
    assert f"{rpm:.4g} rpm were commanded" in result.sentence
    assert word in result.sentence
    assert "Kp" not in result.sentence


@pytest.mark.slow
def test_milliseconds_taken_for_seconds_are_named_as_such() -> None:
    made = slow_run(1, amplitude_turns=12.0)
    columns = {k: v for k, v in made.columns.items() if k != "theta_ref"} | {"t": 1e3 * made.columns["t"]}
    conditions = {"speed_rpm": 4 * 12.0 * 0.01 * 60}
    result = analyse(replace(made, columns=columns, manifest={**made.manifest, "conditions": conditions}))
    assert result.verdict is Verdict.INCONCLUSIVE
    assert result.sentence.startswith("The unit of t looks wrong: the motor turns at ")
    assert "1/1000: is t in ms? Expected s." in result.sentence


def commanded_by_nobody(made: MadeRun) -> MadeRun:
    columns = {k: v for k, v in made.columns.items() if k != "theta_ref"}
    return replace(made, columns=columns, manifest={**made.manifest, "conditions": {}, "encoders": {}})


def test_a_speed_that_goes_by_a_doubtful_unit_of_time_is_no_verdict() -> None:
    made = commanded_by_nobody(slow_run(1))
    result = analyse(replace(made, columns={**made.columns, "t": 1e3 * made.columns["t"]}))
    assert result.verdict is Verdict.INCONCLUSIVE
    assert result.sentence.startswith("The unit of t may be another one: 1 s between rows, expected ")


def test_sides_taken_for_each_other_are_told() -> None:
    made = commanded_by_nobody(slow_run(1))
    swapped = {"theta_m": made.columns["theta_l"], "theta_l": made.columns["theta_m"]}
    result = analyse(replace(made, columns={**made.columns, **swapped}))
    assert result.verdict is Verdict.INCONCLUSIVE
    assert "; θ_m and θ_l seem to be taken for each other: expected the motor's angle in theta_m." in result.sentence


def test_angles_that_read_a_half_are_told_by_the_orders() -> None:
    made = commanded_by_nobody(slow_run(1, amplitude_turns=12.0))
    result = analyse(scaled(made, 0.5))
    assert result.verdict is Verdict.INCONCLUSIVE
    assert "both angles seem to read 1/2 of what they should" in result.sentence


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({500: np.inf}, "One value of theta_m is infinite: taken as missing (inf in row 500; expected up to 1e+09)."),
        ({500: -np.inf, 700: np.inf}, "2 values of theta_m are infinite: taken as missing (-inf in row 500;"),
        ({500: 1e12}, "One value of theta_m is absurdly large: taken as missing (1e+12 in row 500;"),
        ({500: 1e12, 700: np.inf}, "2 values of theta_m are infinite or absurdly large: taken as missing (1e+12"),
    ],
)
def test_a_value_that_is_none_is_said_to_be_infinite_or_too_large(wrong: dict[int, float], said: str) -> None:
    made = slow_run(1)
    theta_m = made.columns["theta_m"].copy()
    theta_m[list(wrong)] = list(wrong.values())
    told = " ".join(analyse(replace(made, columns={**made.columns, "theta_m": theta_m})).cannot)
    assert said in told
    assert "theta_m has no usable value in" in told


def test_a_gap_is_named_with_its_channel_and_rows_and_the_figure_is_that_of_the_rest() -> None:
    made = slow_run(1)
    theta_l = made.columns["theta_l"].copy()
    theta_l[5000:60000] = np.nan
    result = analyse(replace(made, columns={**made.columns, "theta_l": theta_l}))
    said = " ".join(result.cannot)
    assert (
        f"55000 of {theta_l.size} rows left out: theta_l has no usable value in 55000 of them (row 5000 to 59999)"
        in said
    )
    assert "gap of 55 s at t = 5.0 s" in said
    (found,) = (e for e in result.estimates if e.name == "kinematic_error_peak_to_peak")
    (whole,) = (e for e in analyse(made).estimates if e.name == "kinematic_error_peak_to_peak")
    assert found.value == pytest.approx(whole.value, abs=0.5)  # arcsec
