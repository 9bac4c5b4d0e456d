"""A wrong place or pattern is refused before a campaign is traced, not after."""

from __future__ import annotations

from pathlib import Path

import pytest

from rig.analysis.tracing.runs.holdout import refuse_unmatched
from rig.cli import main
from rig.core.errors import Exit, UsageError
from tests.hostile.test_campaigns import campaign


@pytest.fixture
def untraced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A campaign that nobody may trace."""

    def never(*_: object) -> None:
        raise AssertionError("traced")

    monkeypatch.setattr("rig.analysis.tracing.trace.trace", never)
    return campaign(tmp_path / "c", lambda c: c)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--json", "{}/nowhere/trace.json"], "cannot write {}/nowhere/trace.json: there is no folder {}/nowhere"),
        (["--json", "{}"], "cannot write {}: it is a folder; name another place with --json"),
        (["--out", "{}/file/x"], "Not a directory; name another place with --out"),
        (["--hold-out", "run-*", "--hold-out", "speed_*"], "--hold-out speed_* fits no run; there are run-0, run-1"),
    ],
)
def test_what_cannot_be_done_with_the_answer_is_said_before_the_question(
    untraced: Path, options: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("in the way")
    assert main(["trace", str(untraced), *(word.replace("{}", str(tmp_path)) for word in options)]) == Exit.USAGE
    assert said.replace("{}", str(tmp_path)) in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["c", "file"]


def test_the_json_may_lie_in_a_folder_that_is_made_for_the_report(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def asked(*_: object) -> None:
        raise UsageError("traced")

    monkeypatch.setattr("rig.analysis.tracing.trace.trace", asked)
    folder, out = campaign(tmp_path / "c", lambda c: c), tmp_path / "new"
    main(["trace", str(folder), "--out", str(out), "--json", str(out / "t.json")])
    assert "cannot write" not in (said := capsys.readouterr().err)
    assert "traced" in said


def test_case_counts_in_a_pattern() -> None:
    refuse_unmatched(["run-0"], ["run-?"])
    refuse_unmatched([], ["anything"])
    with pytest.raises(UsageError, match="RUN"):
        refuse_unmatched(["run-0"], ["RUN-0"])
