"""The twin's process: the assembly with everything that reaches it, served until it is stopped."""

from __future__ import annotations

import gc
from pathlib import Path
from typing import final

from sim.wire.assembly import Assembly
from sim.wire.control import Control
from sim.wire.frame import Frame
from sim.wire.hub import Hub
from sim.wire.reactor import Reactor, Source
from sim.wire.verbs import plant_verbs


SETTLED = 0.1  # s, modelled: the nodes have booted when the first host comes


@final
class Process:
    """Listens from the moment it is made. `lines` tell a person how to reach it."""

    def __init__(self, assembly: Assembly, bus: Path, control: Path) -> None:
        self.assembly = assembly
        _ = Frame(0, bytes(8)).bits  # compiled code is loaded now, not between the first two frames
        assembly.agenda.run_until(SETTLED)
        self.reactor = Reactor(assembly.agenda)
        self.doors: list[Source] = [
            Hub(assembly.bus, self.reactor, bus, self.reactor.stamp),
            Control(self.reactor, control, plant_verbs(assembly, self.reactor)),
        ]
        nodes = ", ".join(f"{node.id} {node.identity.name}" for node in assembly.nodes)
        rate = f"{assembly.bus.bitrate / 1e3:g} kbit/s"
        self.lines = [
            f'CAN      can.Bus(interface="hdrig-unix", channel="{bus}"), {rate}, {nodes}',
            f'control  {control}, one JSON object a line, for example {{"do": "help"}}',
        ]

    def run(self) -> None:
        """Serve until the reactor is stopped; then everything is closed."""
        gc.freeze()  # what was made so far stays: collections of it would only cost time
        try:
            self.reactor.run()
        finally:
            for door in self.doors:
                door.close()
