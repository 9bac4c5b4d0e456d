"""Folders made by other hands, or damaged: always a sentence, never an exception, nothing on stderr."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

from rig.analysis import Result, Verdict, analyse
from tests.analysis.synthetic import MadeRun
from tests.analysis.test_analyse import PROCEDURES, at_speed
from tests.some import some

ODD: tuple[Any, ...] = ("word", ["a", 1], None, float("nan"), float("inf"), 10**400, {"x": {"y": [1]}}, -1, True, {})


class OddRun(MadeRun):
    """A run whose manifest is no help: ratio and procedure stand for themselves."""

    @property
    def ratio(self) -> float:
        return float(self.manifest.get("odd_ratio", 50.0))


def told(columns: Any, manifest: dict[str, Any], procedure: str) -> Result:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = analyse(OddRun(columns, {"procedure": procedure, **manifest}))
    assert result.sentence
    assert "broke off" not in result.sentence, result.sentence
    return result


@pytest.mark.slow
@pytest.mark.parametrize("key", some(["declared", "encoders", "limits", "conditions", "gear", "files", "status"], 3))
@pytest.mark.parametrize("value", ODD, ids=lambda v: str(type(v).__name__))
def test_any_table_of_the_manifest_may_be_anything(key: str, value: Any) -> None:
    short = at_speed(seconds=4.0).columns
    for procedure in ("kinematic_error", "standstill"):
        told(short, {key: value}, procedure)
        told(short, {key: {"K": value, "motor_counts_per_rev": value, "mean_speed": value}}, procedure)
        told(short, {key: {"mean_speed": {"upper": value}, "ratio": value}}, procedure)


@pytest.mark.slow
@pytest.mark.parametrize("procedure", some(PROCEDURES, 3))
def test_any_column_may_hold_anything(procedure: str) -> None:
    whole = dict(at_speed(seconds=4.0, tau_l=np.zeros(4000), flags=np.zeros(4000)).columns)
    for name in whole:
        for factor in (1e300, 1e-300, 1e-15, 1e15, 1e6, 0.0, -1.0, np.inf, np.nan, 2.0**63):
            if name == "t" and factor == -1.0:
                continue
            with np.errstate(all="ignore"):
                told({**whole, name: whole[name] * factor}, {}, procedure)
        holes = whole[name].copy()
        holes[100::7] = np.inf
        told({**whole, name: holes}, {}, procedure)


@pytest.mark.parametrize("ratio", [1e300, 1e-300, 1e7])
def test_a_ratio_no_gear_has_settles_nothing(ratio: float) -> None:
    result = told(at_speed(seconds=2.0).columns, {"odd_ratio": ratio}, "kinematic_error")
    assert result.verdict is Verdict.INCONCLUSIVE


@pytest.mark.slow
@pytest.mark.parametrize("procedure", PROCEDURES)
@pytest.mark.parametrize("rate", [1e3, 1e4, 1e6])
@pytest.mark.parametrize("rows", [16, 17, 40, 200])
def test_a_short_run_at_any_rate_ends_in_a_sentence(procedure: str, rate: float, rows: int) -> None:
    t = np.arange(rows) / rate
    theta = np.linspace(0.0, 20.0, rows)
    told({"t": t, "theta_m": theta, "theta_l": theta / 50}, {}, procedure)


@pytest.mark.parametrize("procedure", PROCEDURES)
@pytest.mark.parametrize("rows", [0, 1])
def test_a_run_of_which_nothing_could_be_measured_is_inconclusive(procedure: str, rows: int) -> None:
    columns = {n: c[:rows] for n, c in at_speed().columns.items()}
    assert told(columns, {}, procedure).verdict is Verdict.INCONCLUSIVE
    nothing = {**at_speed().columns, "theta_m": np.full(10_000, np.nan)}
    assert told(nothing, {}, procedure).verdict is Verdict.INCONCLUSIVE
    assert told({"t": np.arange(100.0)}, {}, procedure).verdict is Verdict.INCONCLUSIVE


def test_a_run_that_ended_before_its_first_sample_is_said_to_have_no_rows() -> None:
    manifest = {"schema": "hdrig.run/1", "gear": {"ratio": 50}, "procedure": "kinematic_error", "rows": 0}
    said = analyse(MadeRun({}, {**manifest, "status": "stopped", "exit_reason": "stopped by the operator"}))
    assert said.verdict is Verdict.INCONCLUSIVE
    assert "The run has no rows, it ended before its first sample" in said.sentence
    assert "No row of the run has a motor angle" in analyse(MadeRun({}, {**manifest, "rows": 5})).sentence


@pytest.mark.parametrize("procedure", ["kinematic_error", "constant_torque", "constant_speed"])
def test_a_run_meant_to_turn_that_made_no_whole_turn_is_inconclusive(procedure: str) -> None:
    t = np.arange(0, 2, 1e-3)
    assert told({"t": t, "theta_m": t, "theta_l": t / 50}, {}, procedure).verdict is Verdict.INCONCLUSIVE


def test_a_hyphen_before_a_number_is_a_minus_and_no_other_is() -> None:
    from rig.analysis.findings.collected import true_minus

    assert true_minus("-5 to -3.2, 1e-5, 2026-11-20, open-1 (-1)") == "−5 to −3.2, 1e-5, 2026-11-20, open-1 (−1)"


@pytest.mark.parametrize(("procedure", "absent"), [("constant_speed", True), ("coast_down", False)])
def test_a_torque_that_is_zero_in_every_row_was_not_measured(procedure: str, absent: bool) -> None:
    columns = dict(at_speed(seconds=4.0, tau_l=np.zeros(4000), tau_m=np.zeros(4000)).columns)
    said = told(columns, {}, procedure).cannot
    assert any("tau_l is exactly 0 in all 4000 rows" in note for note in said)
    assert any("tau_m is exactly 0 in all" in note for note in said) == absent, "a motor runs down without a torque"


def test_a_torque_without_a_number_in_any_row_is_said_to_be_absent() -> None:
    columns = dict(at_speed(seconds=4.0, tau_l=np.full(4000, np.nan)).columns)
    said = told(columns, {}, "constant_speed").cannot
    assert sum("tau_l has no value in any of its 4000 rows" in note for note in said) == 1
