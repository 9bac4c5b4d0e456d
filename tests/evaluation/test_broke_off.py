"""An analysis that breaks off leaves run, result and traceback; a mistake of ours is called one."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from rig.analysis.analyse import PROCEDURES
from rig.cli import main
from rig.evaluation.identification import beside
from rig.evaluation.traceback_file import NAME, broke_off
from rig.runfile.run import Run
from tests.commands.made_run import made_run

pytestmark = pytest.mark.usefixtures("no_pictures")


def stumble(monkeypatch: pytest.MonkeyPatch, error: Exception) -> None:
    """The analysis of slow and friction runs raises `error` from now on."""

    def stumbling(*of_a_run: Any) -> None:
        raise error

    for procedure in ("kinematic_error", "friction"):
        monkeypatch.setitem(PROCEDURES, procedure, stumbling)  # type: ignore[arg-type]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (AttributeError("no such thing"), 70, "on a defect of hdrig, please report it (AttributeError: no such thing)"),
        (NameError("forgotten"), 70, "on a defect of hdrig, please report it (NameError: forgotten)"),
        (IndexError("out of bounds"), 6, "on what this run holds (IndexError: out of bounds)"),
    ],
)
def test_an_analysis_that_breaks_off_says_on_what_and_keeps_where(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
    error: Exception, code: int, words: str,
) -> None:  # fmt: skip
    run = made_run(tmp_path / "run")
    with monkeypatch.context() as now:
        stumble(now, error)
        assert main(["analyse", str(run)]) == code
    said = capsys.readouterr()
    result = json.loads((run / "result.json").read_text())
    assert (result["verdict"], result["estimates"]) == ("INCONCLUSIVE", {})
    assert f"{words}. Where it did stands in {NAME}." in result["sentence"]
    assert result["sentence"] in said.out
    assert (words in said.err) is (code == 70)
    trace = (run / NAME).read_text()
    assert "in stumbling" in trace
    assert main(["verify", str(run)]) == 0
    assert main(["analyse", str(run)]) == 0
    assert not (run / NAME).exists(), "of an analysis that is past"


def test_what_a_report_breaks_off_with_in_a_campaign_is_a_sentence_and_a_traceback(tmp_path: Path) -> None:
    try:
        raise TypeError("of two kinds")
    except TypeError as error:
        said = broke_off(tmp_path, error)
    assert "on a defect of hdrig" in said
    assert f"{tmp_path / NAME}" in said
    assert "TypeError: of two kinds" in (tmp_path / NAME).read_text()
    assert "defect" not in broke_off(tmp_path, OSError("no space left on device"))


def test_identify_says_which_run_beside_it_could_not_be_analysed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = Run.open(made_run(tmp_path / "rubbing", {"procedure": "friction"}))
    stumble(monkeypatch, AttributeError("no such thing"))
    said: list[str] = []
    assert beside([run], said.append) == {}
    assert any("rubbing: The analysis broke off on a defect of hdrig" in text for text in said)
