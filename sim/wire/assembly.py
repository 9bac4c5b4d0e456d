"""The whole twin on the wire: plant, bus, nodes, and what reaches them."""

from __future__ import annotations

from typing import final

from sim.parameters import TwinParameters
from sim.wire.agenda import Agenda
from sim.wire.bus import Bus
from sim.wire.cia402 import ServoDrive
from sim.wire.cia404 import TorqueTransducer
from sim.wire.cia406 import AbsoluteEncoder
from sim.wire.motor import Rating
from sim.wire.node import Node
from sim.world import World

DRIVE, ENCODER, TORQUE = 1, 2, 3  # node numbers
CATCH_UP = 0.005  # s, the plant moves at least this often


@final
class Assembly:
    """Nodes 1 (drive), 2 (load encoder), 3 (torque transducer) on a bus of `bitrate` bit/s, one plant behind them."""

    def __init__(self, parameters: TwinParameters, seed: int, rating: Rating, bitrate: float) -> None:
        self.world = World(parameters, seed)
        self.agenda = Agenda()
        self.bus = Bus(self.agenda, bitrate)
        self.drive = ServoDrive(self.bus, DRIVE, self.world, rating)
        self.encoder = AbsoluteEncoder(self.bus, ENCODER, self.world)
        self.torque = TorqueTransducer(self.bus, TORQUE, self.world)
        self.nodes: tuple[Node, ...] = (self.drive, self.encoder, self.torque)
        self._catch_up()

    def _catch_up(self) -> None:
        self.world.advance_to(self.agenda.now)
        self.agenda.after(CATCH_UP, self._catch_up)
