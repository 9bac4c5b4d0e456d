"""A wrong place or pattern is refused before a campaign is traced, not after."""

from __future__ import annotations

import argparse
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing.runs.holdout import refuse_unmatched, split
from rig.cli import main
from rig.commands.targets import alone_in
from rig.commands.trace import progress, run
from rig.core.errors import Exit, UsageError
from tests.hostile.test_campaigns import campaign
from tests.report.trace import made_up


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
        (
            ["--hold-out", "run-*", "--hold-out", "speed_*"],
            "--hold-out 'speed_*' fits none of the 2 runs; expected one of run-0, run-1",
        ),
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


def test_a_folder_that_another_trace_writes_to_is_refused_and_left_as_it_was(
    untraced: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (out := tmp_path / "out").mkdir()
    (out / "trace.json").write_text("the other's")
    with alone_in(out):
        assert main(["trace", str(untraced), "--out", str(out)]) == Exit.NOT_READY
    assert "being written by another process" in capsys.readouterr().err
    assert (out / "trace.json").read_text() == "the other's"


def test_a_trace_that_is_stopped_while_its_page_is_made_leaves_what_was_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A page of one campaign beside the figures of another would be believed."""

    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("rig.analysis.tracing.trace.trace", lambda *_: made_up.explained())
    monkeypatch.setattr("rig.report.trace.page.render", stopped)
    folder, new, old = campaign(tmp_path / "c", lambda c: c), tmp_path / "new", tmp_path / "old"
    old.mkdir()
    (old / "trace.json").write_text("of before")
    for out in (new, old):
        with pytest.raises(KeyboardInterrupt):
            run(argparse.Namespace(campaign=folder, out=out, json=None, hold_out=[]))
    assert not new.exists()
    assert [(path.name, path.read_text()) for path in old.iterdir()] == [("trace.json", "of before")]


def test_a_run_is_no_campaign_and_standstill_alone_is_nothing_to_fit(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = campaign(tmp_path / "c", lambda c: c)
    assert main(["trace", str(folder / "run-0")]) == Exit.USAGE
    assert "run-0 is a run: expected a campaign, the folder of runs it lies in" in capsys.readouterr().err
    still: Any = [SimpleNamespace(procedure="standstill", name="still")] * 2
    with pytest.raises(UsageError, match="nothing but standstill: expected runs in which the motor turns"):
        split(still, [])


def test_case_counts_in_a_pattern() -> None:
    refuse_unmatched(["run-0"], ["run-?"])
    refuse_unmatched([], ["anything"])
    with pytest.raises(UsageError, match="RUN"):
        refuse_unmatched(["run-0"], ["RUN-0"])


def test_of_many_runs_the_first_are_named_and_the_rest_are_counted() -> None:
    names = [f"run-{i:02d}" for i in range(36)]
    with pytest.raises(UsageError, match=r"none of the 36 runs; expected one of run-00, .*, run-07 and 28 more in"):
        refuse_unmatched(names, ["xyz"])
    with pytest.raises(UsageError, match="did you mean 'run-17'"):
        refuse_unmatched(names, ["run17"])


@pytest.mark.parametrize("terminal", [True, False])
def test_a_terminal_is_told_what_a_trace_is_at_and_nobody_else(
    terminal: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: terminal)
    progress()("36 runs read")
    heard = capsys.readouterr()
    assert heard.out == ""
    assert heard.err == ("   0 s  36 runs read\n" if terminal else "")
