"""The drivers and the twin's bytes in one process and one virtual time."""

from __future__ import annotations

from typing import NamedTuple

from rig.bench import BENCHES, Bench, override, read, twin_parameters
from rig.config.bench_file import read_bench
from rig.instruments import Instruments
from sim.wire.assembly import Assembly
from sim.wire.bus import Bus
from sim.wire.inprocess import VirtualWire
from sim.wire.motor import Rating
from sim.wire.odrive import Axis, Settings

RATING = Rating(3.0, 0.5)  # N·m, N·m/A


class Wired(NamedTuple):
    """A bench whose devices are reached over frames only."""

    bench: Bench
    wire: VirtualWire
    instruments: Instruments

    @property
    def twin(self) -> Assembly:
        """The other end."""
        return self.wire.assembly


MADE: list[Wired | Driven] = []  # by the running test; closed when it ends


def wired(*overrides: str) -> Wired:
    """Not connected yet."""
    bench = read("twin-canopen", overrides)
    twin = read("twin").file
    assembly = Assembly(twin_parameters(twin), 7, RATING, 1e6)
    wire = VirtualWire(assembly)
    wire.wait_until(0.1)  # the nodes have booted
    made = Wired(bench, wire, bench.wired(wire, connect=wire.connect))
    MADE.append(made)
    return made


class Driven(NamedTuple):
    """An ODrive on a bus of its own, encoder and torque sensor over CANopen; one plant, one virtual time."""

    bench: Bench
    wire: VirtualWire
    instruments: Instruments
    axis: Axis


TWO_BUSES = """
[bus.drive]
interface = "hdrig-unix"
channel = "odrive"
bitrate = 1000000
"""


def odriven(settings: Settings | None = None, *overrides: str) -> Driven:
    """Not connected yet; the axis has booted."""
    text = (BENCHES / "twin-canopen.toml").read_text(encoding="utf-8")
    old = text[text.index("[devices.drive]") : text.index("[devices.load_encoder]")]
    text = (
        text.replace(old, '[devices.drive]\ntype = "can.odrive"\nbus = "drive"\nnode = 5\nwatchdog = 0.15\n')
        + TWO_BUSES
    )
    text = override(text, list(overrides), "twin-canopen with an ODrive")
    bench = Bench(read_bench(text, "ODrive"), text, "ODrive")
    assembly = Assembly(twin_parameters(read("twin").file), 7, RATING, 1e6)
    wire = VirtualWire(assembly)
    own = Bus(assembly.agenda, 1e6)
    axis = Axis(own, 5, assembly.world, RATING, settings or Settings(heartbeat=0.02, watchdog=0.15))
    wire.wait_until(0.5)
    doors = {"odrive": wire.door(own)}
    connect = lambda channel, **_: doors.get(channel, wire.connect)()  # noqa: E731
    made = Driven(bench, wire, bench.wired(wire, connect=connect), axis)
    MADE.append(made)
    return made
