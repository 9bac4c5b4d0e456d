"""The drivers and the twin's bytes in one process and one virtual time."""

from __future__ import annotations

from typing import NamedTuple

from rig.bench import Bench, read, twin_parameters
from rig.instruments import Instruments
from sim.wire.assembly import Assembly
from sim.wire.inprocess import VirtualWire
from sim.wire.motor import Rating


class Wired(NamedTuple):
    """A bench whose devices are reached over frames only."""

    bench: Bench
    wire: VirtualWire
    instruments: Instruments

    @property
    def twin(self) -> Assembly:
        """The other end."""
        return self.wire.assembly


MADE: list[Wired] = []  # by the running test; closed when it ends


def wired(*overrides: str) -> Wired:
    """Not connected yet."""
    bench = read("twin-canopen", overrides)
    twin = read("twin").file
    assembly = Assembly(twin_parameters(twin), 7, Rating(twin.motor.torque_rated, 0.5), 1e6)
    wire = VirtualWire(assembly)
    wire.wait_until(0.1)  # the nodes have booted
    made = Wired(bench, wire, bench.wired(wire, connect=wire.connect))
    MADE.append(made)
    return made
