"""The catalogue of faults: what the bus, the nodes and the sensors can do to a run."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rig.drill.cause import Cause, Expected
from rig.drill.rig import DrillRig

STALE = 0.006  # s: limits.stale_s of the drill's bench, and the tick it is seen in
AT_ONCE = 0.001  # s: with the next SYNC
BOOT = 0.06  # s a node takes to say that it is there
HEARTBEAT = 0.175  # s: three and a half heartbeats of 50 ms
MODE_CHANGE = 0.003  # s a drive takes from 6060h to 6061h, and the next SYNC
MOTION = 1.2  # s: only its effect shows: 0.4° of twist takes 0.35 s at 9.6 rpm, a following error about as long
AT_REST = frozenset({"idle", "stopping", "locked and loaded"})  # nothing moves: nothing shows
NOT_RUNNING = frozenset({"idle", "enabling"})  # what a run starts from is where it starts
SOON_OVER = frozenset({"stopping"})  # at rest in 30 ms


def verb(name: str, *args: Any, **options: Any) -> Callable[[DrillRig], object]:
    """One of the twin's faults by its name on the command channel."""
    return lambda rig: rig.verbs[name](*args, **options)


def _back_with_queue(rig: DrillRig) -> None:
    def join() -> None:
        rig.verbs["join"]()

    rig.verbs["cut"](keeps=True)
    rig.assembly.agenda.after(0.05, join)


def stall(rig: DrillRig) -> None:
    rig.wire.stall(0.03)


CAUSES: tuple[Cause, ...] = (
    Cause("host's cable pulled", verb("cut"), STALE),
    Cause("cable pulled, back after 50 ms with what was queued", _back_with_queue, STALE, unseen=frozenset({"idle"})),
    Cause("host's controller bus-off", verb("bus_off"), STALE),
    Cause("drive's cable pulled", verb("cut", "node 1"), STALE),
    Cause("SYNC lost", verb("drop", 0x080), STALE),
    Cause("drive's status lost", verb("drop", 0x181), STALE),
    Cause("drive's position lost", verb("drop", 0x281), STALE),
    Cause("drive's commands lost", verb("drop", 0x201), MOTION, unseen=AT_REST),
    Cause("encoder's frames lost", verb("drop", 0x182), STALE),
    Cause("torque sensor's frames lost", verb("drop", 0x183), STALE),
    Cause("three SYNCs lost", verb("drop", 0x080, 3), 0.0, Expected.GO_ON),
    Cause("drive's position 20 ms late", verb("delay", 0.02, 0x281), STALE),
    Cause("frames doubled by the bus", verb("duplicate", 0x281, 4), 0.0, Expected.GO_ON),
    Cause("position frames in wrong order", verb("reorder", 0x281, 4), 0.0, Expected.GO_ON),
    Cause("position frames cut to 2 bytes", verb("resize", 2, 0x281), AT_ONCE),
    Cause("encoder's frames cut to 2 bytes", verb("resize", 2, 0x182), AT_ONCE),
    Cause("babbling node", verb("babble"), STALE),
    Cause("second master", verb("second_master"), 0.0, Expected.GO_ON),
    Cause("two encoders of one number", verb("double", "encoder"), BOOT),
    Cause("drive reboots", verb("reboot", "drive"), STALE),
    Cause("encoder reboots", verb("reboot", "encoder"), STALE),
    Cause("torque sensor reboots", verb("reboot", "torque"), STALE),
    Cause("drive's heartbeat lost", verb("drop", 0x701), HEARTBEAT, unseen=SOON_OVER),
    Cause("encoder's heartbeat lost", verb("drop", 0x702), HEARTBEAT, unseen=SOON_OVER),
    Cause("emergency of the drive", verb("emergency", "drive", 0x4210), AT_ONCE),
    Cause("emergency of the encoder", verb("emergency", "encoder", 0x5000), AT_ONCE),
    Cause("drive trips by itself", verb("trip", 0x3210), AT_ONCE),
    Cause("safe torque off", verb("sto"), AT_ONCE),
    Cause("safe torque off as a fault", verb("sto", fault=True), AT_ONCE),
    Cause("somebody changes the mode", verb("put", "drive", 0x6060, 8), MODE_CHANGE),
    Cause("position jumps by half a turn", verb("position", 5000), AT_ONCE, unseen=NOT_RUNNING),
    Cause("drive's limit lowered by another tool", verb("put", "drive", 0x6072, 30), MOTION, unseen=AT_REST),
    Cause("motor encoder frozen", verb("frozen", "drive"), MOTION, unseen=AT_REST),
    Cause("load encoder frozen", verb("frozen", "encoder"), MOTION, unseen=AT_REST),
    Cause("load encoder slips", verb("jump", "encoder", 0.02), AT_ONCE, unseen=NOT_RUNNING),
    Cause("load encoder the wrong way round", verb("scale", "encoder", -1.0), MOTION, unseen=AT_REST),
    Cause("torque sensor overloaded", verb("overload"), AT_ONCE),
    Cause("torque sensor's cable broken", verb("broken_cable"), AT_ONCE),
    Cause(
        "torque sensor frozen", verb("frozen", "torque"), 0.0, Expected.GO_ON, or_stops=frozenset({"locked and loaded"})
    ),
    Cause(
        "SDO answers 0.4 s late", verb("slow_sdo", "drive", 0.4), 0.0, Expected.GO_ON, or_stops=frozenset({"stopping"})
    ),
    Cause("host stalls for 30 ms", stall, 0.0, Expected.GO_ON),
)
