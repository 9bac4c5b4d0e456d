"""What every device promises, simulated or real: run over all members of the catalogues that can be made here."""

from __future__ import annotations

import importlib
from collections.abc import Iterator

import pytest

import sim
from rig.core.channels import Flag
from rig.core.devices import AngleReading, Device, Drive, DriveReading, Encoder, Identity, TorqueReading, TorqueSensor
from rig.core.errors import NotReady
from rig.core.sample import Torque
from sim.parameters import TwinParameters
from sim.world import World
from tests.sim.conftest import read_twin

READINGS: dict[type[Device], type] = {Drive: DriveReading, Encoder: AngleReading, TorqueSensor: TorqueReading}


def make(kind: str, world: World) -> Device:
    module, name = sim.CATALOGUE[kind].split(":")
    made: Device = getattr(importlib.import_module(module), name)(world)
    return made


@pytest.fixture(scope="module")
def twin() -> TwinParameters:
    return read_twin()


@pytest.fixture
def world(twin: TwinParameters) -> World:
    return World(twin, 11)


@pytest.fixture(params=sorted(sim.CATALOGUE))
def device(request: pytest.FixtureRequest, world: World) -> Iterator[Device]:
    made = make(request.param, world)
    yield made
    made.close()


@pytest.fixture(params=[k for k in sorted(sim.CATALOGUE) if k.endswith("drive")])
def drive(request: pytest.FixtureRequest, world: World) -> Iterator[Drive]:
    made = make(request.param, world)
    assert isinstance(made, Drive)
    yield made
    made.close()


def read(device: Device) -> DriveReading | AngleReading | TorqueReading:
    assert isinstance(device, Drive | Encoder | TorqueSensor)
    return device.read()


def test_every_device_is_of_exactly_one_kind_and_has_a_name(device: Device) -> None:
    assert sum(isinstance(device, kind) for kind in READINGS) == 1
    assert device.name


def test_every_device_says_who_it_is(device: Device) -> None:
    identity = device.connect()
    assert isinstance(identity, Identity)
    assert identity.model


def test_connecting_moves_nothing(device: Device, world: World) -> None:
    before = world.truth()
    device.connect()
    world.wait_until(0.1)
    assert world.truth()[:4] == before[:4]


def test_before_it_is_connected_a_device_is_not_ready(device: Device) -> None:
    with pytest.raises(NotReady, match="not connected"):
        read(device)


def test_connected_it_reads_its_kind_at_once_flagged_as_simulated(device: Device, world: World) -> None:
    device.connect()
    reading = read(device)
    assert isinstance(reading, next(r for kind, r in READINGS.items() if isinstance(device, kind)))
    assert Flag(reading.flags) & Flag.SIMULATED
    assert type(reading.flags) is int
    assert 0.0 <= reading.t - world.now() < 1e-3


def test_time_of_readings_never_goes_back(device: Device, world: World) -> None:
    device.connect()
    times = []
    for k in range(50):
        world.wait_until(k * 7e-4)
        times.extend((read(device).t, read(device).t))
    assert times == sorted(times)
    assert len(set(times)) == 50


def test_reading_twice_at_one_instant_gives_the_same(device: Device, world: World) -> None:
    device.connect()
    world.wait_until(0.02)
    assert read(device) == read(device)


def test_closing_twice_or_unopened_is_no_error_and_a_device_can_be_opened_again(device: Device) -> None:
    device.close()
    device.connect()
    read(device)
    device.close()
    device.close()
    with pytest.raises(NotReady):
        read(device)
    device.connect()
    read(device)


def test_a_drive_takes_nothing_before_it_is_connected(drive: Drive) -> None:
    for act in (drive.enable, drive.reset_fault):
        with pytest.raises(NotReady):
            act()
    assert drive.write(Torque(1.0)) == 0.0


def test_halt_works_in_any_state_any_number_of_times(drive: Drive, world: World) -> None:
    drive.halt()
    drive.connect()
    assert drive.halt() is True
    drive.enable()
    drive.write(Torque(0.4))
    world.wait_until(0.01)
    assert drive.halt() is True
    assert drive.halt() is True
    world.wait_until(0.02)
    assert abs(world.truth().tau_m) < 1e-6
    drive.close()
    drive.halt()


def test_a_drive_carries_torque_only_while_enabled(drive: Drive) -> None:
    drive.connect()
    assert drive.write(Torque(0.3)) == 0.0
    drive.enable()
    assert drive.write(Torque(0.3)) == pytest.approx(0.3, abs=0.002)
    drive.halt()
    assert drive.write(Torque(0.3)) == 0.0


def test_closing_a_drive_leaves_it_without_torque(drive: Drive, world: World) -> None:
    drive.connect()
    drive.enable()
    drive.write(Torque(0.4))
    world.wait_until(0.005)
    drive.close()
    world.wait_until(0.02)
    assert abs(world.truth().tau_m) < 1e-6


def test_a_drive_with_nothing_wrong_reports_no_fault(drive: Drive, world: World) -> None:
    drive.connect()
    drive.enable()
    for k in range(1, 100):
        drive.write(Torque(0.2))
        world.wait_until(k * 1e-3)
        assert drive.read().fault == ""
