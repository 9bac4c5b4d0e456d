"""A limit stands until another one, or none, is said: to analyse a run again lifts no verdict."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from rig.analysis.findings.result import Result
from rig.commands.limits import limits_of
from rig.evaluation.run import analyse_folder
from tests.commands.made_run import made_run

pytestmark = pytest.mark.usefixtures("no_pictures")

NAME = "kinematic_error_peak_to_peak"


def analysed(folder: Path, *limits: str) -> Result:
    return analyse_folder(folder, folder, limits=limits_of(limits))[0]


def notes(result: Result) -> list[str]:
    return [sentence for sentence in result.cannot if sentence.startswith("Judged by the limit")]


@pytest.mark.slow
def test_a_run_is_judged_again_by_the_limit_it_was_judged_by_until_told_otherwise(tmp_path: Path) -> None:
    folder = made_run(tmp_path / "run")
    assert analysed(folder, "peak-to-peak=60 arcsec").verdict == "FAIL"
    again = analysed(folder)
    assert (again.verdict, again.former) == ("FAIL", ())
    assert notes(again) == [
        "Judged by the limit set in an earlier analysis (Kinematic error, peak to peak at most 60 arcsec): "
        "--limit NAME=LIMIT sets another one of the same name, --limit NAME=none none."
    ]
    other = analysed(folder, "peak-to-peak=2 arcmin")
    assert (other.verdict, notes(other)) == ("PASS", [])
    assert [former.verdict for former in other.former] == ["FAIL"]
    lifted = analysed(folder, "peak-to-peak=none")
    assert (lifted.verdict, lifted.limits) == ("MEASURED", {})
    assert analysed(folder).verdict == "MEASURED"


@pytest.mark.slow
@pytest.mark.long
def test_a_limit_of_the_manifest_is_its_own_and_can_be_lifted(tmp_path: Path) -> None:
    folder = made_run(tmp_path / "run", {"limits": {NAME: {"upper": 60.0}}})
    for _ in range(2):
        result = analysed(folder)
        assert (result.verdict, notes(result)) == ("FAIL", [])
    assert analysed(folder, "peak-to-peak=none").verdict == "MEASURED"
    assert analysed(folder).verdict == "MEASURED"


@pytest.mark.slow
@pytest.mark.long
def test_what_a_result_holds_for_limits_may_be_anything(tmp_path: Path) -> None:
    folder = made_run(tmp_path / "run")
    odd: list[Any] = [7, [], {NAME: []}, {NAME: {"upper": [1]}}, {NAME: float("nan")}]
    for asked in odd:
        (folder / "result.json").write_text(json.dumps({"verdict": "FAIL", "asked": asked}))
        assert analysed(folder).sentence
