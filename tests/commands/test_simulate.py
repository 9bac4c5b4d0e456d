"""hdrig simulate: what it refuses."""

from __future__ import annotations

import pytest

from rig.cli import main


@pytest.mark.parametrize("asked", [["--load", "nan"], ["--load", "inf"], ["--start", "nan"]])
def test_a_torque_that_is_no_number_is_refused_before_anything_is_said(
    asked: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["simulate", "twin", *asked]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert "in N·m" in said.err
