"""What a trace says in the terminal: what is not explained too, and one run is one run."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rig.commands.trace import tell
from tests.report.trace import made_up


def test_a_channel_that_stays_above_its_floor_is_said_beside_the_name(capsys: pytest.CaptureFixture[str]) -> None:
    tell(replace(made_up.explained(), ratios_after={"theta_l": 1.5, "tau_m": 1.0, "tau_l": 1.0}))
    assert "Not all of it: the kinematic error stays at 1.5 times its floor." in capsys.readouterr().out
    tell(made_up.explained())
    assert "Not all of it" not in capsys.readouterr().out


def test_one_held_out_run_is_one(capsys: pytest.CaptureFixture[str]) -> None:
    tell(replace(made_up.nothing(), held_out=("a",)))
    assert "on 1 held-out run: 1.00" in capsys.readouterr().out


def test_runs_that_were_left_out_are_counted_and_named(capsys: pytest.CaptureFixture[str]) -> None:
    tell(replace(made_up.nothing(), read=7, left_out=("torn",)))
    assert "7 of 8 runs read. Left out: torn." in capsys.readouterr().out
    tell(replace(made_up.nothing(), read=7))
    assert "Left out" not in capsys.readouterr().out
