"""The verdicts before this one: kept as long as they differ, read from any file that is there, told oldest first."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from rig.analysis.findings.result import Former, Result, Verdict
from rig.report.history import told, with_former
from rig.report.record import write_result

LIMIT = {"swing": "Swing at most 60 arcsec"}
FAILED = Result("kinematic_error", Verdict.FAIL, "made up.", (), limits=LIMIT)
WIDER = replace(FAILED, verdict=Verdict.PASS, limits={"swing": "Swing at most 120 arcsec"})


def judged(folder: Path, *results: Result) -> Result:
    for result in results:
        made = with_former(folder, result)
        write_result(folder, made)
    return made


def test_each_verdict_that_differs_joins_the_history_and_the_same_again_does_not(tmp_path: Path) -> None:
    made = judged(tmp_path, FAILED, FAILED, WIDER, WIDER, FAILED)
    assert made.former == (Former("FAIL", LIMIT), Former("PASS", WIDER.limits))
    assert made.verdict is Verdict.FAIL
    assert told(made).count("FAIL by Swing at most 60 arcsec") == 2
    assert told(made, last=1).startswith("judged before: PASS by Swing at most 120 arcsec; now FAIL by")


def test_a_run_judged_once_has_nothing_to_tell(tmp_path: Path) -> None:
    assert told(judged(tmp_path, FAILED, FAILED)) == ""


def test_a_result_from_before_limits_were_kept_speaks_by_its_checks(tmp_path: Path) -> None:
    checks = [{"name": "speed", "sentence": "Even."}, {"name": "limit_swing", "sentence": "Swing 93, limit 60 arcsec."}]
    (tmp_path / "result.json").write_text(json.dumps({"verdict": "FAIL", "checks": checks}))
    assert "FAIL by Swing 93, limit 60 arcsec; now PASS" in told(with_former(tmp_path, WIDER))


@pytest.mark.parametrize("there", ["no JSON", [1], {"verdict": 3}, {"former": 7}, {"former": [1, {"verdict": None}]}])
def test_a_file_that_says_nothing_is_no_history(tmp_path: Path, there: Any) -> None:
    (tmp_path / "result.json").write_text(there if isinstance(there, str) else json.dumps(there))
    assert with_former(tmp_path, FAILED) == FAILED


def test_what_is_damaged_beside_a_verdict_is_left_out(tmp_path: Path) -> None:
    (tmp_path / "result.json").write_text(json.dumps({"verdict": "PASS", "checks": [3, {"name": 1}], "former": {}}))
    assert with_former(tmp_path, FAILED).former == (Former("PASS", {}),)
