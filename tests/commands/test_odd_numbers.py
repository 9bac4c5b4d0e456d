"""Numbers that nothing can be run with are refused before anything moves."""

from __future__ import annotations

import pytest

from rig.cli import main
from rig.core.errors import Exit


@pytest.mark.parametrize(
    ("command", "said"),
    [
        (["compensate", "--gear", "twin", "--speed", "nan"], "--speed nan: expected rpm"),
        (["compensate", "--gear", "twin", "--speed", "0"], "--speed 0: expected rpm"),
        (["compensate", "--gear", "twin", "--revolutions", "0"], "--revolutions 0: expected 3"),
        (["close-loop", "--budget-minutes", "0"], "--budget-minutes 0: expected minutes"),
        (["close-loop", "--budget-minutes", "nan"], "--budget-minutes nan: expected minutes"),
        (["run", "kinematic-error", "--dry-run", "--with", "amplitude_deg=1e99"], "expected a number below 1e+12"),
        (["run", "kinematic-error", "--dry-run", "--with", "amplitude_deg=inf"], "expected a finite number"),
        (["run", "kinematic-error", "--dry-run", "--set", "gear.N=nan"], "gear.N = nan: expected a finite number"),
        (["run", "kinematic-error", "--dry-run", "--set", "gear.serial=''"], "expected a text of at least 1 character"),
        (["run", "sign-and-scale", "--with", "duration=3"], "sign-and-scale has no parameter 'duration'"),
        (["serve", "--port", "99999999"], "ports go from 0, which finds a free one, to 65535"),
        (["twin", "--for", "nan"], "--for nan: expected 0 s or more"),
        (["twin", "--for", "-1"], "--for -1: expected 0 s or more"),
        (["import", ".", "--map", "lara8"], ". is a folder; expected a file ending in one of .csv"),
        (
            ["close-loop", "--plan", "quick", "--budget-minutes", "3"],
            "the 7 runs of the plan and their checks take up to",
        ),
    ],
)
def test_what_cannot_be_run_is_refused(command: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(command) == Exit.USAGE
    assert said in capsys.readouterr().err


@pytest.mark.parametrize(("amplitude", "told"), [("180", True), ("355", True), ("360", False)])
def test_a_stroke_too_short_for_a_figure_is_said_beforehand(
    amplitude: str, told: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", "kinematic-error", "--with", f"amplitude_deg={amplitude}", "--dry-run"]) == 0
    said = capsys.readouterr().out
    assert ("no kinematic error can be had" in said) is told
    assert "swings by less than ±0.01 N·m, from the declared gear" in said
