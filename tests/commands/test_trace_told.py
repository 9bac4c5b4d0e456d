"""What a trace says in the terminal: what is not explained too, and one run is one run."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rig.analysis.tracing.outcome.result import Before
from rig.commands.trace import tell
from rig.model.effect import parameter
from tests.report.trace import made_up


def test_a_channel_that_stays_above_its_floor_is_said_beside_the_name(capsys: pytest.CaptureFixture[str]) -> None:
    tell(replace(made_up.explained(), ratios_after={"theta_l": 1.5, "tau_m": 1.0, "tau_l": 1.0}))
    assert "Not all of it: the kinematic error stays at 1.5 times its floor." in capsys.readouterr().out
    tell(made_up.explained())
    assert "Not all of it" not in capsys.readouterr().out


def test_one_held_out_run_is_one(capsys: pytest.CaptureFixture[str]) -> None:
    base = made_up.nothing()
    one = Before(dict([next(iter(base.before.per_run.items()))]), base.before.pooled)
    tell(replace(base, held_out=("a",), before=one))
    assert "on 1 held-out run: 1.00" in capsys.readouterr().out


def test_a_channel_counts_the_runs_that_have_it(capsys: pytest.CaptureFixture[str]) -> None:
    tell(made_up.explained())
    said = capsys.readouterr().out
    assert "kinematic error on 4 held-out runs" in said
    assert "shaft torque on 3 held-out runs" in said  # the locked one has none


def test_runs_that_were_left_out_are_counted_and_named(capsys: pytest.CaptureFixture[str]) -> None:
    tell(replace(made_up.nothing(), read=7, left_out=("torn",)))
    said = capsys.readouterr().out
    assert said.splitlines()[0].endswith(": no missing effect, 1 of 8 runs was left out")
    assert "7 of 8 runs read. Left out: torn." in said
    tell(replace(made_up.nothing(), read=7))
    assert "Left out" not in capsys.readouterr().out


def test_a_phase_that_may_be_any_is_not_shown(capsys: pytest.CaptureFixture[str]) -> None:
    sizes = (
        parameter("order_2_amplitude", 0.03, 0.001, "N·m"),
        parameter("order_2_phase", 0.4, 0.05, "rad"),
        parameter("order_4_amplitude", 1e-5, 1.4e-4, "N·m"),
        parameter("order_4_phase", 0.0, 11.0, "rad"),
    )
    base = made_up.explained()
    tell(replace(base, effects=(replace(base.effects[0], effect="cogging_torque", parameters=sizes),)))
    said = capsys.readouterr().out
    assert all(name in said for name in ("order_2_phase", "order_4_amplitude"))
    assert "order_4_phase" not in said
