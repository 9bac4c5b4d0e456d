"""The scorer of the blind test: what counts as right, wrong, refused; what happens to a suite somebody touched."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.blind.folder import digest
from tests.blind.generate import main as generate
from tests.blind.intervals import Rate
from tests.blind.marks import Mark, mark, worst_ratio
from tests.blind.score import Tampered, check_hashes, marks_of_all, read_answer
from tests.blind.table import confusion, is_miss, markdown, rows


def hidden(effect: str, form: str = "", role: str = "main", coordinates: tuple[str, ...] = ()) -> dict[str, Any]:
    return {
        "effect": effect, "form": form, "role": role, "coordinates": list(coordinates), "size_alone": 3.0,
        "parameters": {},
    }  # fmt: skip


def truth(kind: str, *parts: dict[str, Any], size: float = 3.0) -> dict[str, Any]:
    main = [p["effect"] for p in parts if p["role"] == "main" and not p["coordinates"]]
    return {"kind": kind, "plan": "complete", "hidden": list(parts), "effects": main, "size": size, "rig": {}}


def said(status: str, *effects: str, **more: Any) -> dict[str, Any]:
    return {"verdict": {"status": status, "effects": list(effects), "rivals": [], "coordinate": None} | more}


def judged(asked: dict[str, Any], answer: dict[str, Any]) -> Mark:
    return mark("case-001", asked, answer, 1.0)


def value_of(marks: list[Mark], start: str) -> str:
    return next(value for name, value in rows(marks) if name.startswith(start))


def test_the_right_first_name_is_a_hit_and_another_a_miss() -> None:
    asked = truth("single", hidden("quadratic_drag"))
    assert judged(asked, said("explained", "quadratic_drag")).first_right
    wrong = judged(asked, said("explained", "stribeck_friction", "quadratic_drag"))
    assert not wrong.first_right
    assert wrong.wrong == ("stribeck_friction",)
    assert confusion([wrong]) == ["| quadratic_drag | stribeck_friction | 1 |"]


def test_naming_a_small_effect_that_is_there_is_no_mistake() -> None:
    asked = truth("crowded", hidden("quadratic_drag"), hidden("cogging_torque", role="small"))
    assert not judged(asked, said("explained", "quadratic_drag", "cogging_torque")).wrong


def test_any_name_for_an_effect_outside_is_wrong_and_only_silence_with_a_coordinate_is_right() -> None:
    asked = truth("outside", hidden("gear_creep", coordinates=("memory", "load")))
    refused = judged(asked, said("unknown_effect", coordinate="memory"))
    assert refused.refused
    assert not is_miss(refused)
    assert is_miss(judged(asked, said("unknown_effect", coordinate="speed")))
    named = judged(asked, said("explained", "hysteretic_stiffness"))
    assert named.wrong == ("hysteretic_stiffness",)
    assert not named.refused


def test_a_clean_campaign_tolerates_nothing_but_no_missing_effect() -> None:
    asked = truth("clean", size=1.0)
    alarms = [judged(asked, said(status)) for status in ("no_missing_effect", "unknown_effect")]
    assert value_of(alarms, "false alarms").startswith("1 of 2")


def test_an_undecidable_case_wants_the_truth_among_the_rivals() -> None:
    asked = truth("ambiguous", hidden("quadratic_drag"))
    assert judged(asked, said("ambiguous", rivals=["thermal_friction_drift", "quadratic_drag"])).handled
    assert not judged(asked, said("ambiguous", rivals=["thermal_friction_drift"])).handled
    assert not judged(asked, said("explained", "thermal_friction_drift")).decent
    named = judged(asked, said("explained", "quadratic_drag"))
    assert named.decent
    assert not named.handled


def test_an_effect_below_one_and_a_half_floors_does_not_count() -> None:
    weak = judged(truth("single", hidden("quadratic_drag"), size=1.4), said("no_missing_effect"))
    assert value_of([weak], "first name right, textbook") == "none tried"


def test_a_pair_is_right_only_when_both_names_are_there_and_no_other() -> None:
    asked = truth("pair", hidden("quadratic_drag"), hidden("cogging_torque"))
    answers = [
        ("quadratic_drag",),
        ("quadratic_drag", "cogging_torque"),
        ("quadratic_drag", "cogging_torque", "lost_motion"),
    ]
    marks = [judged(asked, said("explained", *names)) for names in answers]
    assert [m.exact for m in marks] == [False, True, False]
    one_weak = [replace(m, smallest=1.2) for m in marks]
    assert value_of(one_weak, "two effects") == "none tried"


def test_the_worst_channel_counts_and_one_without_a_floor_does_not() -> None:
    pooled = {
        "kinematic_error_rms_arcsec": 3.0, "floor_kinematic_error_arcsec": 2.0, "tau_m_rms": 1.0, "floor_tau_m": 0.5,
        "tau_l_rms": 9.0, "floor_tau_l": None,
    }  # fmt: skip
    assert worst_ratio({"pooled": pooled}) == 2.0
    assert worst_ratio({"pooled": {}}) is None


def test_parameters_are_compared_where_both_sides_mean_the_same() -> None:
    part = hidden("lost_motion", "sharp") | {"parameters": {"half_gap_rad": 1e-5}}
    answer = said("explained", "lost_motion")
    answer["effects"] = {"lost_motion": {"parameters": {"gap": {"value": 2.2e-5, "ci95": [1.9e-5, 2.5e-5]}}}}
    (compared,) = judged(truth("single", part), answer).compared
    assert compared.covered
    assert compared.relative_error == pytest.approx(0.1)


def test_the_interval_of_no_failure_in_twelve_reaches_to_a_quarter() -> None:
    assert Rate(0, 12).interval() == (0.0, pytest.approx(0.265, abs=1e-3))
    assert Rate(12, 12).interval()[1] == 1.0
    assert str(Rate(0, 0)) == "none tried"


def test_a_case_the_tracer_died_on_is_counted_as_unanswered(tmp_path: Path) -> None:
    answer = tmp_path / "case-001.json"
    answer.with_suffix(".about").write_text(json.dumps({"seconds": 2.0, "exit": 70, "stderr": "…"}), encoding="utf-8")
    assert read_answer(answer) == ({}, 2.0)
    dead = judged(truth("single", hidden("lost_motion")), {})
    assert value_of([dead], "cases without an answer").startswith("1 of 1")
    assert "no answer" in markdown([dead], "today")


def made_up_suite(folder: Path) -> Path:
    run = folder / "case-001" / "run"
    run.mkdir(parents=True)
    (run / "samples.parquet").write_bytes(b"rows")
    (folder / "HASHES").write_text(f"{digest(folder / 'case-001')}  case-001\n", encoding="utf-8")
    return folder


def test_a_suite_somebody_touched_is_refused_but_what_a_tracer_writes_beside_is_not(tmp_path: Path) -> None:
    suite = made_up_suite(tmp_path)
    (suite / "case-001" / "trace.json").write_text("{}", encoding="utf-8")
    check_hashes(suite)
    (suite / "case-001" / "run" / "samples.parquet").write_bytes(b"other rows")
    with pytest.raises(Tampered, match="make the suite anew"):
        check_hashes(suite)


def test_an_unknown_effect_is_refused_with_the_names_there_are(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = generate(["--effect", "stiction", "--seed", "1", "--out", str(tmp_path / "suite")])
    assert code == 2
    assert "no effect called 'stiction': there are angle_dependent_stiffness" in capsys.readouterr().err


def test_cases_of_several_suites_keep_their_suites_name(tmp_path: Path) -> None:
    for suite in ("first", "second"):
        (tmp_path / suite / "truth").mkdir(parents=True)
        text = json.dumps(truth("clean"))
        (tmp_path / suite / "truth" / "case-001.json").write_text(text, encoding="utf-8")
    both = marks_of_all([tmp_path / "first", tmp_path / "second"])
    assert [one.case for one in both] == ["first/case-001", "second/case-001"]
    assert [one.case for one in marks_of_all([tmp_path / "first"])] == ["case-001"]
