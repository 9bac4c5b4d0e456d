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
        (
            ["close-loop", "--plan", "quick", "--budget-minutes", "3"],
            "the 7 runs of the plan and their checks take up to",
        ),
    ],
)
def test_what_cannot_be_run_is_refused(command: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(command) == Exit.USAGE
    assert said in capsys.readouterr().err
