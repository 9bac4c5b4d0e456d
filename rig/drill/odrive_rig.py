"""An ODrive on a bus of its own; encoder and transducer are CANopen's, for serial lines have no virtual time."""

from __future__ import annotations

import struct
from typing import Any, ClassVar, final

from rig.bench import BENCHES, Bench, override
from rig.config.bench_file import read_bench
from rig.config.text_file import load_text
from rig.drill.rig import STALE, DrillRig
from sim.wire.bus import Bus
from sim.wire.faults.of_bus import BusFaults
from sim.wire.faults.of_sensors import SensorFaults
from sim.wire.motor import Rating
from sim.wire.odrive import Axis, Error, Settings, State

NODE = 5
BOOTED = 0.5  # s
SET_TORQUE = NODE << 5 | 0x0E
WATCHDOG = 0.15  # s
SECTION = f'[devices.drive]\ntype = "can.odrive"\nbus = "drive"\nnode = {NODE}\nwatchdog = {WATCHDOG}\n'
SECOND_BUS = '\n[bus.drive]\ninterface = "hdrig-unix"\nchannel = "odrive"\nbitrate = 1000000\n'
OF_THE_BUS = ("drop", "delay", "duplicate", "reorder", "resize", "cut", "bus_off", "join", "send", "babble")


@final
class ODriveRig(DrillRig):
    """Verbs with `drive_` in front of them act on the drive's bus; those without on the other one."""

    longest_row: ClassVar[float] = 2.5e-3  # stamped by arrival: what it says of its own accord may come between

    def read_bench(self) -> Bench:
        """The shipped CANopen bench with another drive."""
        assembly = self.assembly
        self.bus = Bus(assembly.agenda, assembly.bus.bitrate)
        rating = Rating(assembly.drive.rating.torque)
        self.axis = Axis(self.bus, NODE, assembly.world, rating, Settings(heartbeat=0.02, watchdog=WATCHDOG))
        self.wire.wait_until(BOOTED)
        text = load_text(BENCHES / "twin-canopen.toml")
        old = text[text.index("[devices.drive]") : text.index("[devices.load_encoder]")]
        text = override(text.replace(old, SECTION) + SECOND_BUS, [STALE], "the drill's bench")
        return Bench(read_bench(text, "the drill's bench"), text, "the drill's bench")

    def connect(self, **options: Any) -> Any:
        """Either bus by its channel; only what goes to the drive is recorded. Its faults become verbs here."""
        if options.get("channel") != "odrive":
            return self.wire.connect(**options)
        faults = BusFaults(self.bus)
        self.verbs |= {f"drive_{name}": getattr(faults, name) for name in OF_THE_BUS}
        motor = SensorFaults(self.assembly, {"odrive": self.axis.motor.sensors})
        self.verbs |= {"drive_frozen": lambda: motor.frozen("odrive"), "drive_fails": self._fail}
        return self.recorded(self.wire.door(self.bus)())

    def _fail(self) -> None:
        self.axis.fail(Error.DC_BUS_UNDER_VOLTAGE)

    def torque_in(self, identifier: int, data: bytes) -> bool:
        """Set_Input_Torque."""
        return identifier == SET_TORQUE and struct.unpack_from("<f", data)[0] != 0.0

    @property
    def energised(self) -> bool:
        """Closed loop."""
        return self.axis.state is State.CLOSED_LOOP_CONTROL
