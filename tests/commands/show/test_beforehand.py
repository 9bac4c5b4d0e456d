"""A program that reads --json is told of a refusal and of a dry run as it is of a run."""

from __future__ import annotations

import json
from typing import Any

import pytest

from rig.cli import main


def events(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, list[dict[str, Any]]]:
    """Exit code of hdrig `words` with --json, and what its standard output tells."""
    code = main([*words, "--json"])
    return code, [json.loads(line) for line in capsys.readouterr().out.splitlines()]


@pytest.mark.parametrize(
    ("words", "said", "told"),
    [
        (("run", "nonsense"), 2, "no procedure called 'nonsense'"),
        (("run", "kinematic-error", "--with", "x=3"), 2, "has no parameter 'x'"),
        (("campaign", "nonsense"), 2, "no plan called 'nonsense'"),
        (("close-loop", "--budget-minutes", "0"), 2, "expected minutes of rig time above 0"),
        (("run", "kinematic-error", "--with", "amplitude_deg=2e5", "--dry-run"), 3, "the bench allows 144000 deg"),
    ],
)
def test_a_refusal_is_one_exit_event(
    words: tuple[str, ...], said: int, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, found = events(capsys, *words)
    assert code == said
    assert [one["event"] for one in found if one["event"] != "said"] == ["exit"]
    assert found[-1]["code"] == said
    assert told in found[-1]["error"]


@pytest.mark.parametrize("words", [("run", "kinematic-error"), ("campaign", "paper-short")])
def test_the_lines_of_a_dry_run_are_said(words: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*words, "--dry-run", "--seed", "1"]) == 0
    lines = capsys.readouterr().out.splitlines()
    code, found = events(capsys, *words, "--dry-run", "--seed", "1")
    assert code == 0
    assert [one["text"] for one in found[:-1]] == lines
    assert (found[-1]["event"], found[-1]["code"]) == ("exit", 0)


@pytest.mark.parametrize("words", [("run",), ("campaign", "quick", "--bogus"), ("close-loop", "--seed", "x")])
def test_a_wrong_command_line_is_one_exit_event(words: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    """It was a sentence on stderr and no line on stdout."""
    with pytest.raises(SystemExit, match="2"):
        main([*words, "--json"])
    said = capsys.readouterr()
    (event,) = [json.loads(line) for line in said.out.splitlines()]
    assert (event["event"], event["code"]) == ("exit", 2)
    assert said.err == f"hdrig: {event['error']}\n"


def test_a_wrong_command_line_of_a_verb_without_events_is_a_sentence_alone(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["list", "--bogus", "--json"])
    assert capsys.readouterr().out == ""
