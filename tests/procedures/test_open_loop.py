"""A torque that nothing corrects is held to the bench's limits before it is given, by the speed that it leads to."""

from __future__ import annotations

from pathlib import Path

import pytest

from rig.cli import main
from rig.core.errors import Exit
from rig.core.units import RPM
from rig.procedures.step_test import StepTest
from tests.analysis.recorded import Rig
from tests.fakes import SETTING

BEYOND = "of motor torque, the bench allows 5 N·m"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("constant-torque", "torque=99"), f"asks for up to 99 N·m {BEYOND}"),
        (("constant-torque", "speed_rpm=-310", "torque=-99"), f"asks for up to 99 N·m {BEYOND}"),
        (("sentinel", "torque=6"), f"asks for up to 6 N·m {BEYOND}"),
        (("step-test", "torque=99"), f"asks for up to 99 N·m {BEYOND}"),
        (("sign-and-scale", "nudge_share=5"), f"asks for up to 25 N·m {BEYOND}"),
        (("constant-torque", "torque=0.9"), "torque = 0.9 N·m takes the motor to 1678 rpm by the declared inertia"),
        (("sentinel", "torque=0.9"), "of motor speed (torque = 0.9 N·m takes the motor to 1678 rpm"),
        (("step-test", "torque=5"), "of motor speed (torque = 5 N·m, on = 0.06 s), the bench allows 600 rpm"),
        (("step-test", "on=60"), "the bench allows"),
    ],
)
@pytest.mark.parametrize("more", [("--dry-run",), ()])
def test_a_torque_beyond_the_bench_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], words: tuple[str, ...], told: str, more: tuple[str, ...]
) -> None:
    name, *given = words
    options = [part for one in given for part in ("--with", one)]
    assert main(["run", name, *options, *more, "--out", str(tmp_path)]) == Exit.NOT_READY
    assert told in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_dry_run_tells_where_a_torque_leads_and_not_what_was_asked_for(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", "constant-torque", "--with", "torque=0.435", "--dry-run", "--out", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert "speed       382.579 of 600 rpm" in said
    assert "open loop   torque = 0.435 N·m takes the motor to 333 rpm" in said


@pytest.mark.slow
def test_without_declared_friction_the_most_it_can_be_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    asked = ["run", "constant-torque", "--with", "torque=0.435", "--dry-run", "--set", "gear.tau_c=0"]
    assert main([*asked, "--out", str(tmp_path)]) == Exit.NOT_READY
    assert "no gear.tau_c: hdrig run friction measures it" in capsys.readouterr().err


@pytest.mark.parametrize("torque", [0.8, 1.6])
def test_the_twin_stays_within_what_a_step_test_is_told_to_reach(torque: float) -> None:
    procedure = StepTest(torque=torque)
    told = procedure.envelope(SETTING)
    columns = Rig().run(procedure).run.columns
    fastest = abs(columns["omega_m"]).max()
    assert 0.7 * told.speed < fastest < told.speed + 10.0 * RPM
    assert abs(columns["theta_m"] - columns["theta_m"][0]).max() < told.travel
