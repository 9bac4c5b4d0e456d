"""The lock test on the twin, end to end: slow run, pin in, wound up and down, analysed against the truth, reported."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest

from rig.analysis import analyse
from rig.bench import read
from rig.cli import main
from rig.core.operator import LockOutput
from rig.procedures.kinematic_error import KinematicError
from rig.procedures.stiffness_lock import StiffnessLock
from rig.process.interrupts import Interrupts
from rig.runfile.run import Run
from rig.session import Session

pytestmark = pytest.mark.slow

STIFFNESS = "twin.effects.stiffness."
LINES = [STIFFNESS + x for x in ("T1=4", "T2=10", "K2=9500", "K3=12500")]


def figures(root: Path, overrides: list[str]) -> dict[str, Any]:
    """Slow run and lock test in one session, as a campaign makes them: the motor encoder keeps its zero."""
    with Interrupts() as interrupts, Session(read("twin", overrides), "virtual", root, interrupts) as session:
        session.prove()
        slow = session.run(KinematicError(amplitude_deg=720.0, frequency=0.02, cycles=1.0))
        session.change(LockOutput())
        lock = session.run(StiffnessLock(rate=1.5, cycles=2, hold=1.0, rates=(1.0, 0.3, 3.0)))
    result = analyse(Run.open(lock.folder), Run.open(slow.folder))
    return {e.name: e for e in result.estimates} | {"sentence": result.sentence}


@pytest.mark.long
def test_a_straight_spring_is_found_with_its_stiffness(tmp_path: Path) -> None:
    found = figures(tmp_path, [])
    assert "one line describes it" in found["sentence"]
    for name in ("torsional_stiffness", "stiffness_K1", "stiffness_K2", "stiffness_K3"):
        assert abs(found[name].value / 7160 - 1) < 0.02, name
    assert abs(found["torsional_stiffness"].value / 7160 - 1) < 0.005
    assert found["torsional_stiffness"].ci95[0] < 7160 < found["torsional_stiffness"].ci95[1]
    for name in ("hysteresis_loss", "loop_hysteretic"):
        assert found[name].ci95[0] < 0.0 < found[name].ci95[1], name
    width = found["hysteresis_loss"].ci95[1] - found["hysteresis_loss"].ci95[0]
    assert width < 0.13, "arcmin: three counts"


@pytest.mark.long
def test_three_lines_are_found_with_their_knots(tmp_path: Path) -> None:
    found = figures(tmp_path, LINES)
    for name, true in (("stiffness_K1", 7160), ("stiffness_K2", 9500), ("stiffness_K3", 12_500)):
        assert abs(found[name].value / true - 1) < 0.02, name
    assert abs(found["knot_T1"].value - 4.0) < 0.3
    assert abs(found["knot_T2"].value - 10.0) < 0.3


@pytest.mark.long
def test_a_cubic_spring_is_found_with_both_coefficients(tmp_path: Path) -> None:
    found = figures(tmp_path, [STIFFNESS + "cubic=2.3e9"])
    assert "a cubic describes it better" in found["sentence"]
    assert abs(found["cubic_k1"].value / 7160 - 1) < 0.02
    assert abs(found["cubic_k3"].value / 2.3e9 - 1) < 0.03


@pytest.mark.long
def test_a_hysteretic_spring_has_its_loss_and_its_lines(tmp_path: Path) -> None:
    loop = ["twin.effects.hysteresis.torque=0.5", "twin.effects.hysteresis.twist_deg=0.02"]
    found = figures(tmp_path, [*LINES, *loop])
    true = 2 * 0.5 / 7160 * 180 * 60 / math.pi
    assert abs(found["hysteresis_loss"].value / true - 1) < 0.05
    assert "The loop is hysteretic:" in found["loop_viscous"].how
    for name, true in (("stiffness_K1", 7160), ("stiffness_K2", 9500), ("stiffness_K3", 12_500)):
        assert abs(found[name].value / true - 1) < 0.02, name


@pytest.mark.long
def test_a_viscous_spring_is_told_from_a_hysteretic_one_though_the_motor_sticks(tmp_path: Path) -> None:
    found = figures(tmp_path, ["gear.B_sp=2000"])
    assert "The loop is viscous:" in found["loop_viscous"].how
    assert abs(found["loop_viscous"].value / 2000 - 1) < 0.1
    assert abs(found["torsional_stiffness"].value / 7160 - 1) < 0.01


def test_from_the_command_line_to_the_report(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    quick = ["--with", "rate=5", "--with", "cycles=1", "--with", "hold=0.5", "--with", "rates=[1.0, 3.0]"]
    assert main(["run", "stiffness-lock", "--out", str(tmp_path), *quick]) == 0
    printed = capsys.readouterr()
    assert "store 0.016 J" in printed.err
    assert "the output is locked" in printed.err
    assert "System torsional stiffness" in printed.out
    folder = next(p.parent for p in tmp_path.rglob("manifest.json") if "stiffness-lock" in p.parent.name)
    manifest = json.loads((folder / "manifest.json").read_text())
    assert manifest["procedure"] == "stiffness_lock"
    assert manifest["conditions"]["output_locked"] is True
    assert manifest["conditions"]["tau_max"] == 15.0
    assert "Torque against wind-up, output locked" in (folder / "report.html").read_text()
