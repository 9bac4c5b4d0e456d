"""The ODrive driver against the twin's axis, frame by frame, on virtual time; bytes after the maker's document."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from drivers import cansimple as cs
from rig.core.channels import Flag
from rig.core.errors import Exit, NotReady, UsageError
from rig.core.sample import Torque
from sim.wire.odrive import Error, Settings, State
from tests.drivers.running import run
from tests.drivers.virtual import Driven, odriven, wired

OLD = Settings(heartbeat=0.02, watchdog=0.15, knows_torque=False)


def connected(settings: Settings | None = None, *overrides: str) -> Driven:
    w = odriven(settings, *overrides)
    w.instruments.connect()
    return w


def test_frames_are_those_of_the_maker_s_document():
    assert cs.identifier(1, 0x0C) == 0x2C  # the document's own example
    assert cs.encode_torque(1.0) == bytes.fromhex("0000803f")
    assert cs.encode_mode(1, 1) == bytes.fromhex("0100000001000000")
    assert cs.encode_state(8) == bytes.fromhex("08000000")
    assert cs.decode_pair(bytes.fromhex("0000003f000080bf")) == (0.5, -1.0)
    assert cs.decode_heartbeat(bytes.fromhex("0000000108000000")) == (1 << 24, 8)


def test_errors_are_told_in_words_by_the_generation_of_the_firmware():
    assert cs.error_text(1 << 24 | 1 << 9, cs.PRO_ERRORS) == (
        "DC bus under-voltage, watchdog expired: the commands stayed away"
    )
    assert cs.error_text(1 << 11, cs.OLD_ERRORS) == "watchdog expired: the commands stayed away"
    assert cs.error_text(1 << 31, cs.PRO_ERRORS) == "bit 31"


def test_connecting_energises_nothing_and_says_who_is_there():
    w = odriven()
    identity = w.instruments.connect()["drive"]
    assert identity.simulated
    assert identity.firmware == "0.6.10"
    assert w.axis.state is State.IDLE


@pytest.mark.slow
def test_a_slow_run_follows_its_reference_and_every_motor_row_is_fresh():
    w = connected()
    ending, sink = run(w)
    assert ending.exit is Exit.PASS, ending.reason
    assert sum(bool(row[0].flags & Flag.STALE_M) for row in sink.rows) == 0
    moved = max(row[0].theta_m for row in sink.rows) - sink.rows[0][0].theta_m
    assert moved == pytest.approx(math.radians(90), abs=math.radians(2))
    assert w.axis.state is State.IDLE


@pytest.mark.slow
@pytest.mark.parametrize("estimates", [0.01, 0.001], ids=["asked", "unasked"])
def test_readings_are_stamped_when_they_were_made_to_two_tenths_of_a_millisecond(estimates: float):
    w = connected(Settings(heartbeat=0.02, watchdog=0.15, estimates=estimates))
    read, truth = w.instruments.read, []

    def and_look(now: float):
        sample = read(now)
        w.wire.assembly.world.advance_to(w.wire.now())
        truth.append((w.wire.now(), w.wire.assembly.world.truth().theta_m))
        return sample

    w.instruments.read = and_look
    _, sink = run(w)
    rows = [row[0] for row in sink.rows if abs(row[0].omega_m) > 0.8]
    t, theta = np.array(truth).T - [[w.instruments.started], [0.0]]
    ahead = np.array([np.interp(r.t, t, theta) - r.theta_m for r in rows])
    omega = np.array([r.omega_m for r in rows])
    late, _ = np.polyfit(omega, ahead, 1)  # the zero of the encoder drops out: it turns both ways
    assert abs(late) < 0.2e-3


@pytest.mark.parametrize("estimates", [0.0, 0.01, 0.001])
def test_what_it_does_not_tell_often_enough_it_is_asked_for(estimates: float):
    w = connected(Settings(heartbeat=0.02, watchdog=0.15, estimates=estimates))
    asked = w.instruments.drive.bus.requests
    assert (w.instruments.drive.axis.id(cs.ESTIMATES) in asked) is (estimates != 0.001)
    assert w.instruments.drive.axis.id(cs.TORQUES) in asked


def test_a_firmware_that_tells_no_torque_needs_the_torque_constant():
    with pytest.raises(NotReady, match=r"tells no torque.*needs torque_constant in N·m/A"):
        connected(OLD)


def test_with_the_torque_constant_an_old_firmware_serves_as_well():
    w = odriven(OLD)
    w.instruments.drive._constant = 0.5  # N·m/A
    w.instruments.connect()
    w.instruments.drive.enable()
    w.instruments.start()
    for _ in range(50):
        w.instruments.latch()
        sample = w.instruments.read(w.wire.wait_until(w.wire.now() + 0.001))
        w.instruments.write(Torque(0.2))
    assert sample.tau_m == pytest.approx(0.2, abs=0.05)
    assert w.axis.current_limit == pytest.approx(10.0)  # 5 N·m at 0.5 N·m/A


def test_a_command_is_clipped_at_the_limit_and_said_as_f32_carries_it():
    w = connected()
    assert w.instruments.write(Torque(1.0)) == 0.0  # not enabled
    w.instruments.drive.enable()
    w.instruments.drive.read()
    assert w.instruments.write(Torque(7.0)) == 5.0
    assert w.instruments.write(Torque(0.1)) == np.float32(0.1)
    assert w.instruments.write(Torque(math.nan)) == 0.0


def test_of_an_axis_that_is_not_heard_the_torque_it_still_goes_by_is_told():
    """The row said 0 N·m, and the axis gave what it was told last."""
    w = connected()
    w.instruments.drive.enable()
    w.instruments.drive.read()
    given = w.instruments.write(Torque(0.5))
    w.instruments.drive._looked = w.wire.now() + 0.01  # and nothing came
    assert w.instruments.write(Torque(0.7)) == given == 0.5
    w.instruments.drive.halt()
    assert w.instruments.write(Torque(0.7)) == 0.0


def test_an_uncalibrated_axis_does_not_enable_and_is_left_idle():
    w = connected(Settings(heartbeat=0.02, watchdog=0.15, calibrated=False))
    with pytest.raises(NotReady, match=r"stays in 'idle', expected closed-loop control.*bad configuration"):
        w.instruments.drive.enable()
    assert w.axis.state is State.IDLE


def test_when_the_host_falls_silent_the_declared_watchdog_stops_the_axis():
    w = connected()
    assert w.instruments.drive.watchdog.words == "watchdog of the axis, 150 ms, seen to expire"
    w.instruments.drive.enable()
    for _ in range(100):
        w.instruments.latch()
        w.wire.wait_until(w.wire.now() + 0.001)
        w.instruments.drive.read()
        w.instruments.write(Torque(1.0))
    assert w.axis.state is State.CLOSED_LOOP_CONTROL
    w.wire.wait_until(w.wire.now() + 0.2)
    assert w.axis.state is State.IDLE
    assert w.axis.error is Error.WATCHDOG_TIMER_EXPIRED
    assert "watchdog expired" in w.instruments.drive.read().fault


def test_without_a_declared_watchdog_nothing_guards_and_it_is_said():
    w = odriven(Settings(heartbeat=0.02))
    w.instruments.drive._declared = None
    w.instruments.connect()
    assert w.instruments.drive.watchdog.words == ""


def test_a_watchdog_that_is_declared_and_not_set_is_found_out():
    w = connected(Settings(heartbeat=0.02))
    assert "proves nothing" in w.instruments.drive.watchdog.words


@pytest.mark.slow
@pytest.mark.parametrize(
    ("strike", "words"),
    [
        (lambda w: w.axis.fail(Error.DC_BUS_UNDER_VOLTAGE), "DC bus under-voltage"),
        (lambda w: w.axis.power_up(), "no heartbeat|left closed-loop control|jumped|no new motor sample"),
        (lambda w: w.axis.port.disconnect(False), "no heartbeat|no new motor sample"),
        (lambda w: setattr(w.axis, "_zero", w.axis._zero + 7500), "jumped by -0.7"),
        (lambda w: w.axis._disarm(), "left closed-loop control by itself: idle"),
    ],
    ids=["error", "reboot", "cable", "position jumps", "disarmed"],
)
def test_a_fault_in_a_run_ends_it_with_its_reason_and_without_torque(strike, words):
    w = connected()
    w.wire.assembly.agenda.after(1.0, lambda: strike(w))
    ending, _ = run(w)
    assert ending.exit is Exit.TRIPPED
    assert pytest.approx(0.0, abs=1e-3) == w.wire.assembly.world.truth().tau_m or "confirm" in ending.reason
    assert re.search(words, ending.reason), ending.reason


def test_a_fault_is_left_by_a_reset_only_which_energises_nothing():
    w = connected()
    w.axis.fail(Error.DC_BUS_UNDER_VOLTAGE)
    w.wire.wait_until(w.wire.now() + 0.1)
    assert "under-voltage" in w.instruments.drive.read().fault
    with pytest.raises(NotReady, match="reset it first"):
        w.instruments.drive.enable()
    w.instruments.drive.reset_fault()
    assert w.instruments.drive.read().fault == ""
    assert w.axis.state is State.IDLE


def test_nobody_there_is_a_sentence():
    with pytest.raises(NotReady, match=r"ODrive node 9 on CAN bus 'drive'\) sent 0 heartbeats"):
        connected(None, "devices.drive.node=9")


def test_it_shares_no_bus_with_canopen_devices():
    with pytest.raises(UsageError, match=r"a CANopen device on CAN bus 'rig', where others speak CANSimple"):
        odriven(None, 'devices.drive.bus="rig"')


@pytest.mark.slow
def test_no_sync_and_no_heartbeat_of_ours_is_sent_on_its_bus():
    w = connected()
    seen = []
    w.axis.port._bus.attach("ear", lambda frame, t: seen.append(frame.identifier & 0x7FF))
    run(w)
    assert {i >> 5 for i in seen} == {5}


def test_a_canopen_number_of_0_is_refused():
    with pytest.raises(NotReady, match="CANopen has nodes 1 to 127"):
        wired("devices.drive.node=0").instruments.connect()


def test_heartbeats_that_were_held_up_and_came_together_are_not_taken_for_its_rhythm(monkeypatch: pytest.MonkeyPatch):
    """Without time stamps: the axis was then found silent 1 ms after each heartbeat."""
    driven = odriven()
    real = driven.instruments.drive.axis.next_heartbeat  # type: ignore[attr-defined]
    axis = driven.instruments.drive.axis  # type: ignore[attr-defined]

    def together(seconds: float) -> bool:
        if not axis.bus.frames.get(axis.id(0x01)):
            return real(seconds)
        axis.heard += 0.0002
        return True

    monkeypatch.setattr(axis, "next_heartbeat", together)
    axis.open()
    assert axis.interval == pytest.approx(0.02)
    driven.instruments.drive.bus.close()  # type: ignore[attr-defined]
