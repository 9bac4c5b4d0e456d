"""Real drivers against the twin's CANopen nodes, frame by frame, on virtual time."""

from __future__ import annotations

import math
import struct

import pytest

from rig.core.channels import Flag
from rig.core.errors import Exit, NotReady
from rig.core.sample import Torque
from sim.wire.faults import fault_verbs
from sim.wire.frame import Frame
from sim.wire.reactor import Reactor
from sim.wire.states402 import DriveState
from tests.drivers.running import run
from tests.drivers.virtual import Wired, wired


def connected(*overrides: str) -> Wired:
    w = wired(*overrides)
    w.instruments.connect()
    return w


def test_connecting_energises_nothing_and_says_who_is_there():
    w = wired()
    identities = w.instruments.connect()
    assert [i.model for i in identities.values()] == [
        "hdrig twin servo drive",
        "hdrig twin load encoder",
        "hdrig twin torque transducer",
    ]
    assert w.twin.drive.drive_state is DriveState.SWITCH_ON_DISABLED
    assert all(i.simulated for i in identities.values())


@pytest.mark.slow
def test_a_slow_run_follows_its_reference_and_every_row_is_fresh():
    w = connected()
    ending, sink = run(w)
    assert ending.exit is Exit.PASS, ending.reason
    stale = Flag.STALE_M | Flag.STALE_L | Flag.STALE_TAU
    assert sum(bool(row[0].flags & stale) for row in sink.rows) == 0
    assert all(row[0].flags & Flag.SIMULATED for row in sink.rows)
    moved = max(row[0].theta_m for row in sink.rows) - sink.rows[0][0].theta_m
    assert moved == pytest.approx(math.radians(90), abs=math.radians(2))
    assert w.twin.drive.drive_state is DriveState.SWITCH_ON_DISABLED


@pytest.mark.slow
def test_what_is_read_is_what_the_plant_does():
    w = connected()
    run(w)
    w.instruments.latch()
    w.wire.wait_until(w.wire.now() + 0.001)
    sample = w.instruments.read(w.wire.now())
    truth = w.twin.world.truth()
    turn = 2 * math.pi
    assert (sample.theta_m - truth.theta_m + math.pi) % turn - math.pi == pytest.approx(
        (w.twin.drive.motor.position * turn / 10_000 - truth.theta_m + math.pi) % turn - math.pi, abs=turn / 10_000
    )
    assert sample.tau_l == pytest.approx(truth.tau_l, abs=0.3)


def test_a_rated_torque_off_by_a_thousand_is_refused_with_both_numbers():
    w = wired()
    w.twin.drive.rated_torque.value = 3_000_000  # µN·m, as some drives say it
    with pytest.raises(NotReady, match=r"3000 N·m \(6076h\).* is 3 N·m.*factor of 1000"):
        w.instruments.connect()


def test_another_resolution_than_the_bench_file_s_is_refused():
    with pytest.raises(NotReady, match=r"counts 10000 per turn \(608Fh\).*file is 4096"):
        connected("motor.counts_per_turn=4096")


def test_a_node_of_another_profile_is_refused():
    with pytest.raises(NotReady, match=r"CiA 406 device.*expected CiA 402"):
        connected("devices.drive.node=2", "devices.load_encoder.node=1")


def test_a_node_that_is_not_there_is_a_sentence():
    with pytest.raises(
        NotReady, match=r"node 9 on CAN bus 'rig'\) does not answer \(.*\); `hdrig devices` asks every node$"
    ):
        connected("devices.torque_sensor.node=9")


def test_a_bus_on_which_nobody_speaks_is_told_as_such():
    with pytest.raises(
        NotReady, match=r"does not answer \(.*\); nobody is heard on CAN bus 'rig' \(cable, power, bitrate\?\)"
    ):
        connected("devices.drive.node=9")


@pytest.mark.slow
@pytest.mark.parametrize(("station", "more"), [("hosts", "; nobody is heard on CAN bus 'rig'"), ("node 1", "")])
def test_a_heartbeat_that_stays_away_is_told_from_a_bus_that_does(station: str, more: str):
    w = connected("limits.stale_s=0.5", "devices.drive.watchdog=0.6")
    cut = fault_verbs(w.twin, Reactor(w.twin.agenda), {}, {})["cut"]
    w.twin.agenda.after(1.0, lambda: cut(station))
    reason = run(w)[0].reason
    assert "no heartbeat of drive" in reason
    assert (
        reason.partition("one every 50 ms")[2].partition(" (cable")[0].startswith(more or "; the drive did not confirm")
    )


def test_a_unit_that_is_no_torque_is_refused():
    w = wired()
    w.twin.torque.unit.value = 0x00210000  # newton
    with pytest.raises(NotReady, match=r"no torque \(6131h = 00210000h\)"):
        w.instruments.connect()


def test_a_mode_that_is_not_confirmed_energises_nothing():
    w = connected()
    w.twin.drive.mode_stuck = True
    w.instruments.drive.node.sdo.put(0x6060, 0, struct.pack("<b", 8))  # somebody else's tool
    w.twin.drive.mode = 8
    with pytest.raises(NotReady, match="6061h is 8, expected 10"):
        w.instruments.drive.enable()
    w.instruments.safe()
    assert w.twin.drive.drive_state is not DriveState.OPERATION_ENABLED


def test_halt_works_in_any_state_any_number_of_times():
    w = wired()
    assert w.instruments.drive.halt() is False  # not connected: nothing to confirm it
    w.instruments.connect()
    assert w.instruments.drive.halt()
    w.instruments.drive.enable()
    assert w.instruments.drive.halt()
    assert w.instruments.drive.halt()
    assert w.twin.drive.drive_state is DriveState.SWITCH_ON_DISABLED


def test_a_drive_that_brakes_before_it_is_in_fault_is_not_said_to_be_off():
    w = connected()
    drive, twin = w.instruments.drive, w.twin.drive
    drive.enable()
    twin._go(DriveState.FAULT_REACTION_ACTIVE)  # and stays there
    assert not drive.halt()
    twin._go(DriveState.FAULT)
    assert drive.halt()


def test_a_drive_that_reboots_is_seen_to_be_off_though_it_sends_no_pdos_any_more():
    w = connected()
    w.instruments.drive.enable()
    w.twin.drive.power_up()  # its power failed for a moment
    w.wire.wait_until(w.wire.now() + 1.0)
    w.instruments.latch()
    assert "rebooted" in w.instruments.drive.read().fault
    assert w.instruments.drive.halt()


def test_resetting_a_fault_never_energises():
    w = connected()
    w.twin.drive.fault(0x3210)
    w.wire.wait_until(w.wire.now() + 0.1)
    w.instruments.latch()
    w.wire.wait_until(w.wire.now() + 0.01)
    assert w.instruments.drive.read().fault
    with pytest.raises(NotReady):
        w.instruments.drive.enable()
    w.instruments.drive.reset_fault()
    assert w.instruments.drive.read().fault == ""
    assert w.twin.drive.drive_state is DriveState.SWITCH_ON_DISABLED


def test_a_command_while_disabled_is_zero():
    w = connected()
    assert w.instruments.write(Torque(1.0)) == 0.0


def test_when_the_host_falls_silent_the_drive_stops_by_itself():
    w = connected()
    w.instruments.start()
    w.instruments.drive.enable()
    for _ in range(100):
        w.instruments.latch()
        w.wire.wait_until(w.wire.now() + 0.001)
        w.instruments.write(Torque(1.0))
    assert w.twin.drive.drive_state is DriveState.OPERATION_ENABLED
    w.wire.wait_until(w.wire.now() + 0.3)
    assert w.twin.drive.drive_state is DriveState.FAULT
    assert w.instruments.drive.watchdog.words == "heartbeat consumer of the drive, 150 ms, set and read back"


@pytest.mark.parametrize("command", ["80 01", "02 01"])
def test_a_drive_that_somebody_else_has_stopped_is_disabled_by_sdo_and_reset_by_an_act(command: str):
    w = connected()
    drive, twin = w.instruments.drive, w.twin.drive
    twin.abort_option.value = 0  # a lost connection is nothing to this one: it stays enabled, and takes no PDOs
    drive.enable()
    stranger = w.twin.bus.attach("stranger", lambda frame, t: None)
    stranger.send(Frame(0x000, bytes.fromhex(command)))
    w.wire.wait_until(w.wire.now() + 0.1)  # its next heartbeat has told
    w.instruments.latch()
    assert drive.read().fault  # its emergency, or that it is stopped, where it may send none
    assert twin.drive_state is DriveState.OPERATION_ENABLED
    assert drive.halt()
    assert twin.drive_state is DriveState.SWITCH_ON_DISABLED
    drive.reset_fault()
    drive.enable()
    assert twin.drive_state is DriveState.OPERATION_ENABLED


def test_torque_is_cut_without_waiting_for_the_drive_and_confirmed_after():
    w = connected()
    w.instruments.drive.enable()
    now = w.wire.now()
    w.instruments.cut()
    assert w.wire.now() == now  # nothing was waited for
    w.wire.wait_until(now + 0.005)
    assert w.twin.drive.drive_state is DriveState.SWITCH_ON_DISABLED
    assert w.instruments.safe()


@pytest.mark.parametrize(("stale", "told"), [("0.04", "100 ms"), ("0.3", "450 ms")])
def test_a_watchdog_nobody_has_set_is_longer_than_what_the_guard_allows(stale: str, told: str):
    w = wired(f"limits.stale_s={stale}", "devices.drive.watchdog=0.9")
    del w.instruments.drive.place.options["watchdog"]
    w.instruments.connect()
    assert told in w.instruments.drive.watchdog.words
