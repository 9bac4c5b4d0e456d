"""All nodes latch at the moment the SYNC has passed, however long their answers then wait for the bus."""

from __future__ import annotations

import math

import pytest

from sim.wire.frame import Frame
from sim.wire.watch import State
from tests.wire.host import Host, host

TURN = 2 * math.pi


@pytest.fixture
def turning() -> Host:
    """600 rpm at the motor; position, encoder and torque answer SYNC."""
    rig = host("twin.sensor_noise=0.0", "twin.sensor_zero=0.0", "twin.latch_l=0.0", "twin.latch_tau=0.0")
    rig.put(1, 0x1800, 1, "I", 0xC0000181)
    for index, sub, kind, value in [
        (0x1800, 2, "B", 1),
        (0x1A00, 0, "B", 0),
        (0x1A00, 1, "I", 0x60640020),
        (0x1A00, 0, "B", 1),
        (0x1800, 1, "I", 0x40000181),
    ]:
        assert rig.put(1, index, sub, kind, value) == ""
    rig.enable(9)
    rig.start()
    rig.put(1, 0x60FF, 0, "i", 100_000)
    rig.wait(2.0)
    return rig


def test_what_answers_a_sync_was_true_when_it_had_passed(turning: Host) -> None:
    rig = turning
    world, truths = rig.twin.world, []

    def look(frame: Frame, t: float) -> None:
        if frame.identifier == 0x080:
            world.advance_to(t)
            truths.append(world.truth())

    rig.twin.bus.attach("onlooker", look)
    motor, load, torque = [], [], []
    for _ in range(20):
        rig.heard.clear()
        rig.send(0x080)
        rig.wait(0.005)
        answers = {identifier: bytes.fromhex(data) for _, identifier, data in rig.heard}
        motor.append(int.from_bytes(answers[0x181], "little", signed=True) / 10_000 * TURN)
        load.append(int.from_bytes(answers[0x282], "little") / 900_000 * TURN)
        torque.append(int.from_bytes(answers[0x283][:4], "little", signed=True) / 1000)
    first = truths[0]
    for k, truth in enumerate(truths):
        # a count each, rounded down twice; 0.4 ms later the motor would be 40 counts further
        assert motor[k] - motor[0] == pytest.approx(truth.theta_m - first.theta_m, abs=1.1 * TURN / 10_000)
        assert load[k] - load[0] == pytest.approx(truth.theta_l - first.theta_l, abs=1.1 * TURN / 900_000)
        assert torque[k] == pytest.approx(truth.tau_l, abs=0.3)  # behind a low-pass of 1 kHz
    assert truths[-1].theta_m - first.theta_m > 5.0
    assert rig.twin.drive.state is State.OPERATIONAL
