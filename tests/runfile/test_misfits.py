"""What a manifest cannot mean is named with key, value and what was expected, by verify and in an analysis."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from rig.cli import main
from rig.runfile.misfits import misfits
from tests.commands.made_run import made_run, manifest


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            {"procedure": "kinematic-eror"},
            "\"kinematic-eror\", no kind of run there is; did you mean 'kinematic_error'?",
        ),
        ({"conditions": {"tau_ext": "5 N"}}, 'conditions.tau_ext is "5 N", expected a number in N·m'),
        ({"conditions": {"tau_ext": math.nan}}, "conditions.tau_ext is NaN, expected a number in N·m"),
        ({"conditions": {"output_locked": "no"}}, 'conditions.output_locked is "no", expected true or false'),
        ({"declared": {"K": "stiff"}}, 'declared.K is "stiff", expected a number above 0 in N·m/rad'),
        ({"declared": {"J_l": -1}}, "declared.J_l is -1, expected a number above 0 in kg·m²"),
        ({"declared": {"B_m": {"value": -0.1}}}, "expected a number of 0 or more in N·m·s/rad"),
        ({"encoders": {"motor_counts_per_rev": "many"}}, '"many", expected a number above 0 in counts'),
        ({"conditions": {"speed_rpm": 10**5000}}, "conditions.speed_rpm is a int, expected a number in rpm"),
    ],
)
def test_a_value_that_is_none_is_one_clause(change: dict[str, Any], said: str) -> None:
    (found,) = misfits({**manifest(), **change})
    assert said in found


def test_what_is_absent_null_other_or_in_a_table_with_its_unit_is_no_misfit() -> None:
    assert misfits(manifest()) == []
    assert misfits({}) == []
    assert misfits({"procedure": "stiffness-lock", "conditions": {"tau_ext": None, "oil": "old"}, "declared": 7}) == []
    assert misfits({"declared": {"K": {"value": 9000, "unit": "N·m/rad"}, "B_m": 0.0}}) == []


@pytest.mark.slow
def test_verify_calls_it_broken_and_an_analysis_says_it_and_gives_the_figures_all_the_same(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = str(made_run(tmp_path / "run", {"conditions": {"tau_ext": "5 N"}}))
    said = 'conditions.tau_ext is "5 N", expected a number in N·m'
    assert main(["verify", folder]) == 6
    assert f"error   manifest.json: {said}" in capsys.readouterr().out
    assert main(["analyse", folder]) == 0
    assert f"  note: The manifest's {said}." in capsys.readouterr().out
