"""Faults of what is measured, at either end of a gear and between."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import final

from sim.drive import TwinDrive
from sim.faults import Fault, Frozen, Jump, Overload, Scale, Silent
from sim.sensors import TwinLoadEncoder, TwinTorqueSensor
from sim.wire.assembly import Assembly
from sim.wire.faults.words import named

Sensor = TwinDrive | TwinLoadEncoder | TwinTorqueSensor
MOMENT = 1e-6  # s: a sensor is read once at any one time


@final
class SensorFaults:
    """Of what is measured: by the nodes drive, encoder, torque, by the serial devices serial_torque, qsb."""

    def __init__(self, assembly: Assembly, serial: Mapping[str, Sensor]) -> None:
        self._assembly, self._serial = assembly, serial

    def heal(self) -> None:
        """All sound."""
        for device in self._sensors():
            self._put(device, None)
        self._assembly.torque.broken = False

    def choices(self) -> dict[str, Iterable[str]]:
        """What a device may be."""
        return {"device": self._sensors()}

    def standing(self) -> list[str]:
        """What is not sound."""
        wrong = [f"{_said(sensor.fault)} device={name}" for name, sensor in self._sensors().items() if sensor.fault]
        return [*wrong, *(["broken_cable active=true"] if self._assembly.torque.broken else [])]

    def frozen(self, device: str) -> None:
        """The value stays what it is"""
        self._put(device, Frozen())

    def silent(self, device: str) -> None:
        """The sensor gives nothing new behind a node that goes on"""
        self._put(device, Silent())

    def jump(self, device: str, by: float) -> None:
        """A slipped coupling, a shifted zero: rad or N·m"""
        self._put(device, Jump(float(by)))

    def scale(self, device: str, factor: float) -> None:
        """The wrong scale; negative: the wrong way round"""
        self._put(device, Scale(float(factor)))

    def overload(self, sign: int = 1, device: str = "torque") -> None:
        """The torque sensor is at the end of its range"""
        self._put(device, Overload(sign))

    def broken_cable(self, active: bool = True) -> None:
        """The torque sensor's cable to its amplifier is out: not a number"""
        self._assembly.torque.broken = bool(active)

    def _sensors(self) -> dict[str, Sensor]:
        """By name; looked up each time, a drive that has rebooted has another one."""
        a = self._assembly
        return {
            "drive": a.drive.motor.sensors,
            "encoder": a.encoder.encoder,
            "torque": a.torque.sensor,
            **self._serial,
        }

    def _put(self, device: str, fault: Fault | None) -> None:
        sensor = named(self._sensors(), device, "device")
        sensor.fault = fault
        self._assembly.agenda.after(MOMENT, lambda: self._read(sensor))

    def _read(self, sensor: Sensor) -> None:
        """So that what freezes freezes now, not when a host next asks."""
        self._assembly.world.advance_to(self._assembly.agenda.now)
        sensor.read()


def _said(fault: Fault) -> str:
    return type(fault).__name__.lower()
