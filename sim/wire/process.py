"""The twin's process: the assembly with everything that reaches it, served until it is stopped."""

from __future__ import annotations

import gc
import math
from contextlib import ExitStack
from pathlib import Path
from typing import NamedTuple, final

from sim.wire import odrive, qsb, serial_torque
from sim.wire.assembly import Assembly
from sim.wire.bus import Bus
from sim.wire.control import Control
from sim.wire.faults import fault_verbs
from sim.wire.faults.of_sensors import Sensor
from sim.wire.frame import Frame
from sim.wire.hub import Hub
from sim.wire.pty import LineDevice, SerialLine
from sim.wire.reactor import Reactor, Source
from sim.wire.slcan import SerialCan
from sim.wire.socketcand import SocketCand
from sim.wire.verbs import plant_verbs
from sim.world import MOST_LOAD

SETTLED = 0.1  # s, modelled: the nodes have booted when the first host comes
ODRIVE = 0  # its node number, as it leaves the factory


class Doors(NamedTuple):
    """Where the twin can be reached; None: not that way."""

    bus: Path
    control: Path
    serial: Path | None = None  # folder of the links `torque` and `qsb`
    slcan: Path | None = None
    socketcand: int | None = None
    torque_rate: float = 100.0  # lines/s of the serial torque sensor
    odrive: Path | None = None  # a bus of its own


@final
class Process:
    """Listens from the moment it is made. `lines` tell a person how to reach it; its shaft `carries` so many N·m."""

    def __init__(self, assembly: Assembly, doors: Doors, carries: float = MOST_LOAD) -> None:
        self.assembly, self._carries = assembly, carries
        _ = Frame(0, bytes(8)).bits  # compiled code is loaded now, not between the first two frames
        assembly.agenda.run_until(SETTLED)
        self.reactor = Reactor(assembly.agenda)
        self.serial: dict[str, SerialLine] = {}
        self._sensors: dict[str, Sensor] = {}
        self.lines: list[str] = []
        with ExitStack() as opened:  # all of them, or none
            self._opened = opened
            self._open(doors)
            self._opened = opened.pop_all()

    def _open(self, doors: Doors) -> None:
        bus = self.assembly.bus
        nodes = ", ".join(f"{node.id} {node.identity.name}" for node in self.assembly.nodes)
        self._add(Hub(bus, self.reactor, doors.bus, self.reactor.stamp))
        self._tell("CAN", f'can.Bus(interface="hdrig-unix", channel="{doors.bus}"), {bus.bitrate / 1e3:g} kbit/s')
        self._tell("nodes", nodes)
        if doors.socketcand is not None:
            server = SocketCand(bus, self.reactor, doors.socketcand)
            self._add(server)
            self._tell("CAN", f'can.Bus(interface="socketcand", host="127.0.0.1", port={server.port}, channel="can0")')
        if doors.slcan is not None:
            self._line("slcan", doors.slcan, SerialCan(bus), math.inf)
            self._tell("CAN", f'can.Bus(interface="slcan", channel="{doors.slcan}")')
        if doors.odrive is not None:
            self._odrive(doors.odrive)
        if doors.serial is not None:
            self._serial(doors.serial, doors.torque_rate)
        faults = fault_verbs(self.assembly, self.reactor, self.serial, self._sensors)
        verbs = {**plant_verbs(self.assembly, self.reactor, faults["faults"], self._carries), **faults}
        self._add(Control(self.reactor, doors.control, verbs))
        self._tell("control", f'{doors.control}, one JSON object a line, for example {{"do": "help"}}')

    def _odrive(self, path: Path) -> None:
        """An ODrive at the same motor as the CANopen drive; the two are not meant to be used together."""
        assembly = self.assembly
        bus = Bus(assembly.agenda, assembly.bus.bitrate)
        settings = odrive.Settings(heartbeat=0.02, watchdog=0.15)  # s, what WIRING.md tells to set
        axis = odrive.Axis(bus, ODRIVE, assembly.world, assembly.drive.rating, settings)
        self._add(Hub(bus, self.reactor, path, self.reactor.stamp))
        self._tell("CAN", f'can.Bus(interface="hdrig-unix", channel="{path}"), ODrive node {axis.node}, CANSimple')

    def _serial(self, folder: Path, rate: float) -> None:
        agenda, world = self.assembly.agenda, self.assembly.world
        torque, encoder = serial_torque.AsciiTorque(agenda, world, rate), qsb.Qsb(agenda, world)
        self._sensors |= {"serial_torque": torque.sensor, "qsb": encoder.sensor}
        self._line("torque", folder / "torque", torque, serial_torque.BAUD)
        self._line("qsb", folder / "qsb", encoder, qsb.BAUD)
        self._tell("serial", f"{folder}/torque, ASCII torque sensor, {serial_torque.BAUD} baud, {rate:g} lines/s")
        self._tell("serial", f"{folder}/qsb, US Digital QSB at the load encoder, {qsb.BAUD} baud")

    def _line(self, name: str, path: Path, device: LineDevice, baud: float) -> None:
        self.serial[name] = SerialLine(self.assembly.agenda, self.reactor, path, device, baud)
        self._add(self.serial[name])

    def _add(self, door: Source) -> None:
        self._opened.callback(door.close)

    def _tell(self, what: str, how: str) -> None:
        self.lines.append(f"{what:8s} {how}")

    def run(self) -> None:
        """Serve until the reactor is stopped; then everything is closed."""
        gc.freeze()  # what was made so far stays: collections of it would only cost time
        with self._opened:
            self.reactor.run()
