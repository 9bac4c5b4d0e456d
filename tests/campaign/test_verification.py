"""A change by hand counts when the sensors show it: the wrong weight, none, the wrong way, a pin that is not in."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

from rig.changes import judge_lock, judge_tare, judge_weight
from rig.core.errors import NotReady
from rig.core.operator import FreeOutput, HangWeight, LockOutput, Reassemble
from rig.procedures.kinematic_error import KinematicError
from rig.procedures.lock_check import LockCheck, LockProof
from rig.procedures.standstill import Standstill
from rig.procedures.weigh import Weighing
from tests.campaign.rigs import session
from tests.some import some

SHORT = Standstill(duration=0.05)


@pytest.mark.slow
def test_the_weight_that_was_asked_for_is_shown_to_a_few_hundredths(tmp_path: Path) -> None:
    with session(tmp_path) as rig:
        for tau_ext in (0.5, -0.5, 5.0, -15.0):
            told = rig.change(HangWeight(tau_ext))
            assert float(told.split()[0]) == pytest.approx(tau_ext, abs=0.03)
            assert rig.rigging.tau_ext == tau_ext
        done = rig.run(SHORT)
    assert '"tau_ext": -15.0' in (done.folder / "manifest.json").read_text()


WRONG: list[tuple[float, float | None, str]] = [
    (0.5, None, "the weight is not there"),
    (5.0, None, "is it there, and the right way round"),
    (5.5, -5.5, "is it there, and the right way round"),
    (-0.5, 0.5, "the weight pulls the wrong way"),
    (2.0, 3.0, "it is another weight"),
    (10.0, 7.5, "expected -9.96 N·m"),
]


@pytest.mark.slow
@pytest.mark.parametrize("case", some(WRONG, 3), ids=lambda case: str(case[:2]))
def test_another_weight_than_asked_for_is_refused_with_what_hangs_there(
    tmp_path: Path, case: tuple[float, float | None, str]
) -> None:
    asked, hung, words = case
    with session(tmp_path, instead={HangWeight(asked): None if hung is None else HangWeight(hung)}) as rig:
        rig.tare()
        with pytest.raises(NotReady, match=words):
            rig.change(HangWeight(asked))
        with pytest.raises(NotReady, match="what the rig is like is not known"):
            rig.run(SHORT)
        rig.change(HangWeight(0.0))
        assert rig.unsure == ""


@pytest.mark.slow
def test_a_pin_that_is_not_in_is_refused_and_one_that_is_in_lets_a_lock_test_start(tmp_path: Path) -> None:
    with session(tmp_path, instead={LockOutput(): None}) as rig, pytest.raises(NotReady, match="not locked"):
        rig.change(LockOutput())
    with session(tmp_path) as rig:
        assert "the output is locked" in rig.change(LockOutput())
        assert rig.run(LockCheck()).ending.status == "completed"


@pytest.mark.slow
def test_a_pin_left_in_is_refused_by_a_load_that_does_not_follow(tmp_path: Path) -> None:
    with session(tmp_path, instead={FreeOutput(): None}) as rig:
        rig.change(LockOutput())
        with pytest.raises(NotReady, match=r"the output is not free: .* expected at least 50 %"):
            rig.change(FreeOutput())


@pytest.mark.slow
def test_a_locked_gear_that_is_still_wound_up_is_let_out_before_the_pin_is_pulled(tmp_path: Path) -> None:
    from rig.core.sample import Torque

    with session(tmp_path) as rig:
        rig.change(LockOutput())
        drive, clock = rig.instruments.drive, rig.instruments.clock
        drive.enable()
        for _ in range(300):  # 0.8 N·m for 0.3 s, then let go, as after a trip
            drive.write(Torque(0.8))
            clock.wait_until(clock.now() + 0.001)
        drive.halt()
        clock.wait_until(clock.now() + 1.0)
        assert abs(rig.instruments.read(clock.now()).tau_l) > 5.0
        rig.change(FreeOutput())
        assert [p.name for p in tmp_path.rglob("*unwind*")]
        assert abs(rig.instruments.read(clock.now()).tau_l) < 2.0


@pytest.mark.slow
def test_a_gear_fitted_again_is_proven_and_its_sensor_tared_anew(tmp_path: Path) -> None:
    with session(tmp_path) as rig:
        told = rig.change(Reassemble(0.2))
        assert "ratio 49.99" in told or "ratio 50.00" in told
        assert "zero of the torque sensor" in told
        assert (rig.rigging.depth_mm, rig.rigging.assembly) == (0.2, 2)


def test_a_lock_test_on_a_free_output_and_a_slow_run_on_a_locked_one_are_refused(tmp_path: Path) -> None:
    with session(tmp_path) as rig:
        with pytest.raises(NotReady, match="lock-check needs a locked output, and it is free"):
            rig.run(LockCheck())
        rig.rigging = LockOutput().applied(rig.rigging)
        with pytest.raises(NotReady, match="kinematic-error needs a free output, and it is locked"):
            rig.run(KinematicError())
    assert not list(tmp_path.rglob("manifest.json"))


@pytest.mark.slow
def test_a_weight_that_would_keep_a_halted_motor_turning_is_refused_before_anybody_hangs_it(tmp_path: Path) -> None:
    with session(tmp_path) as rig:
        with pytest.raises(NotReady, match=r"\+17 N·m .* 0.34 N·m at the motor.* Hang less than 16"):
            rig.change(HangWeight(17.0))
        assert rig.instruments.operator.asked == []  # type: ignore[union-attr]
        assert rig.unsure == ""


def test_what_does_not_go_together_is_refused_before_anybody_is_asked(tmp_path: Path) -> None:
    with session(tmp_path) as rig:
        rig.rigging = LockOutput().applied(rig.rigging)
        with pytest.raises(NotReady, match="on a locked output loads the lock pin"):
            rig.change(HangWeight(3.0))
        rig.rigging = HangWeight(3.0).applied(FreeOutput().applied(rig.rigging))
        with pytest.raises(NotReady, match="take them off before it is locked"):
            rig.change(LockOutput())
        with pytest.raises(NotReady, match="beyond the torque sensor's limit of ±45 N·m"):
            rig.change(HangWeight(50.0))
        assert rig.instruments.operator.asked == []  # type: ignore[union-attr]


def test_nobody_there_is_a_sentence(tmp_path: Path) -> None:
    with session(tmp_path) as rig:
        rig.instruments.operator = None
        with pytest.raises(NotReady, match="nobody is there who could do this: fit the lock pin"):
            rig.change(LockOutput())


def found(torque: float, error: float = 0.01) -> Weighing:
    return Weighing(torque, torque, 1.0, error, 0.3, "as weighed")


def test_a_sensor_that_was_not_tared_is_refused_with_what_it_shows() -> None:
    with pytest.raises(NotReady, match=r"shows \+1.40 N·m with nothing hung"):
        judge_tare(found(1.4), 45.0)
    assert "+0.400" in judge_tare(found(0.4), 45.0)


def test_a_load_that_is_none_has_no_sign() -> None:
    said = judge_weight(found(0.042), 0.0, zero=0.04)
    assert said.startswith("0.00 N·m on the output, 0 N·m were asked for")
    assert judge_weight(found(-2.54), 2.5, zero=0.0).startswith("+2.54 N·m on the output, +2.5 N·m were")


@pytest.mark.parametrize(("tau_ext", "neighbour"), [(0.5, 0.0), (0.5, 1.0), (7.5, 10.0), (15.0, 10.0)])
def test_neighbours_of_the_load_sweep_are_told_apart(tau_ext: float, neighbour: float) -> None:
    judge_weight(found(0.04 - tau_ext), tau_ext, zero=0.04)
    with pytest.raises(NotReady):
        judge_weight(found(0.04 - neighbour), tau_ext, zero=0.04)


@pytest.mark.parametrize(
    ("motor", "follows", "words"),
    [(0.05, 1.0, "not locked"), (0.05, 0.3, "has play"), (0.01, 0.0, "could not be checked"), (0.05, -0.4, "has play")],
)
def test_a_lock_check_that_shows_anything_but_a_locked_output_is_refused(
    motor: float, follows: float, words: str
) -> None:
    with pytest.raises(NotReady, match=words):
        judge_lock(LockProof(motor, 0.0, 5.0, follows, "as seen"), 0.05)


@pytest.mark.slow
def test_an_output_locked_by_mistake_is_found_before_a_whole_turn_winds_the_gear_up(tmp_path: Path) -> None:
    with session(tmp_path) as rig:
        rig.instruments.drive.world.lock_output()  # type: ignore[attr-defined]
        with pytest.raises(NotReady, match="is the output locked"):
            rig.prove()
        assert rig.folder is not None
    shaft = pq.read_table(rig.folder / "samples.parquet")["tau_l"].to_numpy()
    assert np.max(np.abs(shaft)) < 25.0  # N·m; one turn at 7160 N·m/rad would be 900
