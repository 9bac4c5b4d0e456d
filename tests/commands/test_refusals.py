"""What the command line refuses, each by one sentence with its numbers and exit code 3, and what is left behind."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rig.cli import main
from rig.core.errors import Exit
from rig.core.operator import Change, HangWeight, LockOutput
from sim.operator import TwinOperator

FAST = ("--set", "limits.speed_rpm=1200")


def refused(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """What is said on stderr of a command that has to end with exit code 3."""
    assert main(list(words)) == Exit.NOT_READY, words
    said = capsys.readouterr().err
    assert "Traceback" not in said
    return said


def forgetful(monkeypatch: pytest.MonkeyPatch, kind: type[Change]) -> None:
    """The twin's hand says it has done `kind` of change, and has not."""
    honest = TwinOperator.make

    def make(self: TwinOperator, change: Change) -> None:
        if type(change) is not kind:
            honest(self, change)

    monkeypatch.setattr(TwinOperator, "make", make)


def no_run(root: Path, name: str) -> bool:
    return not [p for p in root.rglob("manifest.json") if name in p.parent.name]


@pytest.mark.slow
def test_a_lock_test_with_a_free_output(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    forgetful(monkeypatch, LockOutput)
    said = refused(capsys, "run", "stiffness-lock", "--out", str(tmp_path))
    assert "hdrig: the output is not locked: the motor turned +" in said
    assert "% of what would follow" in said
    assert "expected less than 25 %: fit the lock pin" in said
    assert no_run(tmp_path, "stiffness-lock")


@pytest.mark.slow
def test_a_slow_run_with_a_locked_output(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    prepared = TwinOperator.__init__

    def left_locked(self: TwinOperator, world: object) -> None:
        prepared(self, world)  # type: ignore[arg-type]
        self.world.lock_output()

    monkeypatch.setattr(TwinOperator, "__init__", left_locked)
    said = refused(capsys, "run", "kinematic-error", "--out", str(tmp_path))
    assert "expected 0.10°: is the output locked or the encoder unplugged?" in said
    assert no_run(tmp_path, "kinematic-error")


@pytest.mark.slow
def test_a_weight_that_is_not_there_is_refused_and_the_campaign_can_be_gone_on_with(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    forgetful(monkeypatch, HangWeight)
    said = refused(capsys, "run", "load-sweep", "--with", "weights=5", "--out", str(tmp_path))
    assert "expected -4.96 N·m within" in said
    assert "for +5 N·m on the output: is it there, and the right way round?" in said
    assert "hdrig campaign --resume" in said
    book = json.loads(next(tmp_path.rglob("campaign.json")).read_text())
    assert book["pending"]["words"] == "hang 5 N·m on the output, pulling forward"
    assert {run["status"] for run in book["runs"]} == {"planned"}
    assert no_run(tmp_path, "kinematic-error")


@pytest.mark.slow
def test_a_weight_that_friction_does_not_hold_is_refused_before_anybody_is_asked_for_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    said = refused(capsys, "run", "load-sweep", "--with", "weights=17", "--out", str(tmp_path))
    assert "halted while it turns it would not stop. Hang less than 16" in said
    book = json.loads(next(tmp_path.rglob("campaign.json")).read_text())
    assert book["pending"] is None, "it was never asked for"


def test_a_torque_beyond_the_sensor(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = refused(capsys, "run", "stiffness-lock", "--with", "tau_max=60", "--out", str(tmp_path))
    assert "up to 81 N·m of shaft torque (tau_max = 60 N·m, and 30 % and 3 N·m more" in said
    assert "the bench allows 45 N·m: limits.shaft_torque, what the torque sensor may carry" in said
    said = refused(capsys, "run", "load-sweep", "--with", "weights=50", "--out", str(tmp_path))
    assert "50.0 N·m are expected at the torque sensor (0.0 N·m of it swing), the bench allows 45 N·m" in said
    assert list(tmp_path.iterdir()) == []


def test_a_loop_that_would_swing_up_by_itself(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for kp in ("1e9", "300"):
        run = ("run", "kinematic-error", "--set", f"control.Kp={kp}", "--out", str(tmp_path))
        said = refused(capsys, *run)
        assert f"the position loop would swing up by itself with Kp {float(kp):g} N·m/rad" in said
        assert "expected gains that let it come to rest: hdrig tune finds some" in said
        assert refused(capsys, *run, "--dry-run") == said
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        ("constant-torque", "--with", "speed_rpm=700"),
        ("constant-torque", "--with", "speed_rpm=-700"),
        ("coast-down", "--with", "speed_rpm=650"),
        ("friction", "--with", "speeds_rpm=100,700"),
        ("sentinel", "--with", "speed_rpm=700"),
        ("kinematic-error", "--with", "frequency=1"),
        ("load-sweep", "--with", "weights=3", "--with", "frequency=1"),
        ("identify", "--with", "speeds_rpm=100,700"),
    ],
)
def test_a_resonance_inside_the_asked_speed_is_predicted_announced_and_kept_clear_of(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], words: tuple[str, ...]
) -> None:
    said = refused(capsys, "run", *words, *FAST, "--out", str(tmp_path))
    assert "order 2 meets the torsional resonance at 755 rpm of the motor" in said
    assert "the shaft torque is expected to swing by ±" in said
    assert "stays below 641 rpm" in said
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_a_resonance_is_entered_only_by_whoever_asks_for_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = ("run", "constant-torque", "--with", "speed_rpm=700", *FAST, "--dry-run", "--out", str(tmp_path))
    assert main(list(asked)) == Exit.NOT_READY
    assert "or `hdrig run … --allow-resonance`" in capsys.readouterr().err
    assert main([*asked, "--allow-resonance"]) == Exit.PASS
    assert "the shaft torque swings by ±26.30 N·m at most" in capsys.readouterr().out
    assert list(tmp_path.iterdir()) == []


def test_a_speed_beyond_the_bench_says_what_of_it_is_reserve(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    said = refused(capsys, "run", "constant-torque", "--with", "speed_rpm=580", "--out", str(tmp_path))
    assert "667 rpm of motor speed (speed_rpm = 580, and 15 % that a torque nothing corrects may miss it by)" in said
    assert "the bench allows 600 rpm: limits.speed_rpm" in said
