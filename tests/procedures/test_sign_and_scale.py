"""The proof passes on a rig that is what it says, and refuses every other one with what it measured."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from rig.core.errors import NotReady
from rig.guard import Guard
from rig.loop import Loop
from rig.procedures.sign_and_scale import Leg, Proof, SignAndScale, judge
from rig.process.interrupts import Interrupts
from rig.supervisor import Act, Supervisor
from rig.timing.ticks import LoopTiming
from tests.fakes import LIMITS, SETTING, FakeWorld, ListSink, instruments


def prove(prepare: Callable[[FakeWorld], None] = lambda w: None, ratio: float = 50.0) -> Proof:
    world, supervisor = FakeWorld(), Supervisor()
    prepare(world)
    supervisor.act(Act.CONNECT)
    supervisor.act(Act.CHECK)
    setting = replace(SETTING, ratio=ratio)
    procedure = SignAndScale()
    guard = Guard(LIMITS, procedure.envelope(setting), ratio)
    rig = instruments(world)
    loop = Loop(rig, supervisor, guard, ListSink(), Interrupts(), LoopTiming(0.001, virtual=True))
    try:
        ending = loop.run(procedure, setting)
    finally:
        assert world.tau == 0.0
    assert isinstance(ending.finding, Proof), ending
    return ending.finding


def test_a_rig_that_is_what_it_says_is_proven_with_its_numbers() -> None:
    proof = prove()
    assert abs(proof.ratio - 50.0) < 0.05
    assert 0.3 < proof.breakaway < 0.4
    assert "ratio 50.0" in proof.sentence
    assert "too small to prove" in proof.sentence  # the fake load needs no torque


@pytest.mark.slow
@pytest.mark.parametrize(
    ("prepare", "words"),
    [
        (lambda w: setattr(w, "load_sign", -1.0), ["flip one encoder", "ratio -50"]),
        (lambda w: setattr(w, "motor_sign", -1.0), ["wrong sign", "expected a positive angle"]),
        (lambda w: setattr(w, "drag", 4.0), ["did not turn", "2.00 N·m"]),
        (lambda w: setattr(w, "load_sign", 0.0), ["load encoder moved 0.000°", "locked"]),
        (lambda w: setattr(w, "load_sign", 1.03), ["measured ratio 48.5", "50"]),
        (lambda w: setattr(w, "load_sign", 0.5), ["measured ratio 100", "counts_per_turn"]),
    ],
)
def test_a_rig_that_is_something_else_is_refused_with_what_was_measured(
    prepare: Callable[[FakeWorld], None], words: list[str]
) -> None:
    with pytest.raises(NotReady) as refusal:
        prove(prepare)
    for word in words:
        assert word in str(refusal.value)


def test_a_dead_motor_encoder_is_refused_before_the_motor_gets_fast() -> None:
    seen: list[float] = []

    def dead(world: FakeWorld) -> None:
        world.motor_sign = 0.0
        advance = world.advance

        def watched(dt: float) -> None:
            advance(dt)
            seen.append(abs(world.omega))

        world.advance = watched  # type: ignore[method-assign]

    with pytest.raises(NotReady, match="is the motor encoder read at all"):
        prove(dead)
    assert max(seen) < 30.0  # rad/s, 286 rpm


def test_an_uneven_motor_proves_nothing_about_the_torque_sensor() -> None:
    forward = Leg(6.28, 6.28 / 50, (-0.4,) * 7 + (-0.39,), slowest=0.02)
    reverse = Leg(-6.28, -6.28 / 50, (0.4,) * 7 + (0.39,), slowest=0.5)
    assert "not judged" in judge(forward, reverse, 0.5, SETTING).sentence
    with pytest.raises(NotReady, match="wrong sign"):
        judge(forward._replace(slowest=0.4), reverse, 0.5, SETTING)


@pytest.mark.slow
def test_a_reversed_torque_sensor_is_refused() -> None:
    def reversed_sensor(world: FakeWorld) -> None:
        advance = world.advance

        def with_torque(dt: float) -> None:
            advance(dt)
            world.tau_l = -1.0 * (world.omega > 0.1) + 1.0 * (world.omega < -0.1)

        world.advance = with_torque  # type: ignore[method-assign]

    with pytest.raises(NotReady, match="torque sensor has the wrong sign"):
        prove(reversed_sensor)


def test_a_drive_that_holds_its_torque_back_is_told_by_what_it_gives() -> None:
    with pytest.raises(NotReady, match=r"up to 2\.00 N·m, of which the drive says it gave 2\.00 N·m \(\+0\.00°\)"):
        prove(lambda w: setattr(w, "drag", 4.0))
