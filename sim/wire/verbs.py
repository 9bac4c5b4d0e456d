"""What the command channel can ask of the plant and the process. Faults are in `faults`."""

from __future__ import annotations

from typing import Any

from rig.core.errors import UsageError
from sim.wire.assembly import Assembly
from sim.wire.control import Verb
from sim.wire.reactor import Reactor
from sim.world import MOST_LOAD


def plant_verbs(
    assembly: Assembly, reactor: Reactor, faults: Verb = dict, carries: float = MOST_LOAD
) -> dict[str, Verb]:
    """load, lock, unlock, reassemble, truth, status, stop. `faults`: the verb that lists what stands, for status;
    `carries`: N·m that the shaft may."""
    world, agenda, bus = assembly.world, assembly.agenda, assembly.bus

    def load(tau_ext: float) -> None:
        """Hang a weight: N·m on the load, positive drives it forward"""
        if abs(tau_ext) > carries:
            expected = f"expected a number from {-carries:g} to {carries:g} N·m"
            raise UsageError(f"a weight of {tau_ext:g} N·m is more than the shaft carries; {expected}")
        world.advance_to(agenda.now)
        world.load_torque(float(tau_ext))

    def lock() -> None:
        """Clamp the output where it is; refused while it turns"""
        world.advance_to(agenda.now)
        world.lock_output()

    def unlock() -> None:
        """Let the output turn again"""
        world.advance_to(agenda.now)
        world.unlock_output()

    def reassemble(depth_mm: float = 0.0) -> None:
        """Take the gear apart and together again, wave generator so far from its depth; refused while it turns"""
        world.advance_to(agenda.now)
        world.reassemble(float(depth_mm))

    def truth() -> dict[str, Any]:
        """What really happens now, SI"""
        world.advance_to(agenda.now)
        return {"t": world.t, **world.truth()._asdict(), "simulated": True}

    def status() -> dict[str, Any]:
        """Bus, nodes, plant, process, standing faults; late: the longest that an event waited since last asked [s]"""
        late, reactor.late = reactor.late, 0.0
        world.advance_to(agenda.now)
        return {
            "t": agenda.now,
            "load": bus.load,
            "frames": bus.frames,
            "stations": [port.name for port in bus.ports],
            "drive": assembly.drive.drive_state.name,
            "error_code": assembly.drive.error_code.number,
            "output": "locked" if world.plant.locked else "free",
            "tau_ext": world.plant.tau_ext,
            "omega_m": world.truth().omega_m,
            "nmt": {node.id: node.state.name for node in assembly.nodes},
            "late": late,
            **(faults() or {}),
        }

    def stop() -> None:
        """End the twin"""
        reactor.stop()

    return {verb.__name__: verb for verb in (load, lock, unlock, reassemble, truth, status, stop)}
