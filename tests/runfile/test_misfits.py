"""What a manifest cannot mean is named with key, value and what was expected, by verify and in an analysis."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from rig.cli import main
from rig.model.gear import SIGMA
from rig.runfile.misfits import FORMAT, OURS, OUTPUTS, misfits, misfits_of_ours, mistyped, notes, usable
from rig.runfile.run import Run
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
        ({"declared": {"K": "stiff"}}, 'declared.K is "stiff", expected a number from 0.01 to 1e+09 N·m/rad'),
        ({"declared": {"J_l": -1}}, "declared.J_l is -1, expected a number from 1e-09 to 1e+06 kg·m²"),
        ({"declared": {"J_l": 1e20}}, "declared.J_l is 1e+20, expected a number from 1e-09 to 1e+06 kg·m²"),
        ({"declared": {"B_m": {"value": -0.1}}}, "expected a number of 0 or more in N·m·s/rad"),
        ({"encoders": {"motor_counts_per_rev": "many"}}, '"many", expected a number from 4 to 1e+12 counts'),
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
    assert f"  note: manifest.json: {said}. It counts as not said." in capsys.readouterr().out


ODD = [[], [1], {}, {"x": 1}, "", "abc", True, math.nan, math.inf, 10**400, -1, [[]]]
NESTED = [".".join(path) for path in (*FORMAT, *OURS)]


@pytest.mark.parametrize("key", NESTED)
def test_whatever_a_key_holds_it_is_of_its_kind_or_named_and_taken_out(key: str) -> None:
    table, _, name = key.rpartition(".")
    kind = {**FORMAT, **OURS}[tuple(key.split("."))]
    for odd in ODD:
        about = {**manifest(), **({table: {name: odd}} if table else {name: odd})}
        said = [*misfits(about), *misfits_of_ours(about)]
        here = usable(about)[table] if table else usable(about)
        assert (name in here) == (not said)
        if said:
            assert said == [f"{key} is {said[0].removeprefix(f'{key} is ').partition(', expected')[0]}, expected "
                            f"{kind.expected}"]  # fmt: skip


def test_what_is_usable_has_numbers_bare_and_leaves_the_manifest_as_it_is() -> None:
    about = {**manifest(), "conditions": {"tau_ext": {"value": -5, "unit": "N·m"}, "assembly": [], "oil": {"x": 1}}}
    assert usable(about)["conditions"] == {"tau_ext": -5.0, "oil": {"x": 1}}
    assert about["conditions"]["assembly"] == []
    assert usable({"files": {"samples.parquet": {"sha256": 7, "rows": 3}}}) == {
        "files": {"samples.parquet": {"rows": 3}}
    }


def test_the_outputs_are_those_of_the_model() -> None:
    assert set(OUTPUTS) == set(SIGMA)


def test_a_run_has_its_manifest_without_misfits_and_a_sentence_for_each(tmp_path: Path) -> None:
    run = Run.open(made_run(tmp_path / "run", {"conditions": {"assembly": [], "tau_ext": 1.0}, "campaign": "summer"}))
    assert run.conditions == {"tau_ext": 1.0}
    assert notes(run.misfits) == [
        "manifest.json: conditions.assembly is [], expected a number or a name. It counts as not said.",
        'manifest.json: campaign is "summer", expected an object. It counts as not said.',
    ]


def test_a_key_of_ours_that_somebody_else_means_otherwise_breaks_no_promise(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = str(made_run(tmp_path / "run", {"campaign": "summer"}))
    assert main(["verify", folder]) == 0
    assert 'warning manifest.json: campaign is "summer", expected an object' in capsys.readouterr().out


def test_a_list_and_a_comparison_say_it_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made_run(tmp_path / "run", {"gear": {"ratio": 50, "serial": ["A1"]}})
    assert main(["list", str(tmp_path)]) == 0
    assert (
        'run  (manifest.json: gear.serial is ["A1"], expected a number or a name. It counts' in capsys.readouterr().out
    )


@pytest.mark.parametrize(
    ("table", "key", "meant"),
    [
        ("conditions", "locked", "output_locked"),
        ("conditions", "tau_exr", "tau_ext"),
        ("encoders", "motor_counts_per_turn", "motor_counts_per_rev"),
        ("conditions", "operator_mood", ""),
        ("conditions", "settle_s", ""),
    ],
)
def test_a_key_that_looks_like_one_of_the_format_is_pointed_out(table: str, key: str, meant: str) -> None:
    said = list(mistyped({table: {key: 1.0}}))
    assert [f"did you mean '{meant}'?" in clause for clause in said] == [True] * bool(meant)


def test_a_key_beside_the_one_it_looks_like_is_another() -> None:
    assert not list(mistyped({"conditions": {"locked": "by hand", "output_locked": True}}))
