"""What can go wrong with an ODrive and its bus, and with the sensors beside it."""

from __future__ import annotations

from rig.drill.cause import Cause, Expected
from rig.drill.causes import AT_ONCE, AT_REST, MOTION, NOT_RUNNING, SOON_OVER, STALE, stall, verb
from rig.drill.odrive_rig import NODE, SET_TORQUE
from rig.drill.rig import DrillRig

ESTIMATES, TORQUES, HEARTBEAT = NODE << 5 | 0x09, NODE << 5 | 0x1C, NODE << 5 | 0x01
TOLD = 0.021  # s: errors and states are told in heartbeats, one every 20 ms
OVERDUE = 0.072  # s: three and a half heartbeats of 20 ms, and the tick it is seen in
ESTOP, SET_STATE, REBOOT = (f"0x{NODE << 5 | command:03X}" for command in (0x02, 0x07, 0x16))
AXIS = f"ODrive node {NODE}"


def _back_with_queue(rig: DrillRig) -> None:
    rig.verbs["drive_cut"]("host", keeps=True)
    rig.assembly.agenda.after(0.05, lambda: rig.verbs["drive_join"]("host"))


CAUSES: tuple[Cause, ...] = (
    Cause("host's cable to the drive pulled", verb("drive_cut", "host"), STALE),
    Cause("cable pulled, back after 50 ms with what was queued", _back_with_queue, STALE, unseen=NOT_RUNNING),
    Cause("host's controller bus-off", verb("drive_bus_off", "host"), STALE),
    Cause("drive's cable pulled", verb("drive_cut", AXIS), STALE),
    Cause("drive's commands lost", verb("drive_drop", SET_TORQUE), MOTION, unseen=AT_REST),
    Cause("drive's estimates lost", verb("drive_drop", ESTIMATES), STALE),
    Cause("drive's torques lost", verb("drive_drop", TORQUES), STALE),
    Cause("drive's heartbeats lost", verb("drive_drop", HEARTBEAT), OVERDUE, unseen=SOON_OVER),
    Cause("three estimates lost", verb("drive_drop", ESTIMATES, 3), 0.0, Expected.GO_ON),
    Cause("drive's estimates 20 ms late", verb("drive_delay", 0.02, ESTIMATES), STALE),
    Cause("estimates doubled by the bus", verb("drive_duplicate", ESTIMATES, 4), 0.0, Expected.GO_ON),
    Cause("estimates in wrong order", verb("drive_reorder", ESTIMATES, 4), 0.0, Expected.GO_ON),
    Cause("estimates cut to 2 bytes", verb("drive_resize", 2, ESTIMATES), AT_ONCE),
    Cause("babbling node on the drive's bus", verb("drive_babble"), STALE),
    Cause("somebody lets the axis idle", verb("drive_send", SET_STATE, "01000000"), TOLD, unseen=NOT_RUNNING),
    Cause("somebody sends its emergency stop", verb("drive_send", ESTOP), TOLD),
    Cause("drive reboots", verb("drive_send", REBOOT), STALE, unseen=frozenset({"idle"})),
    Cause("drive fails by itself", verb("drive_fails"), TOLD),
    Cause("motor encoder frozen", verb("drive_frozen"), MOTION, unseen=AT_REST),
    Cause("encoder's frames lost", verb("drop", 0x182), STALE),
    Cause("torque sensor's frames lost", verb("drop", 0x183), STALE),
    Cause("encoder reboots", verb("reboot", "encoder"), STALE),
    Cause("emergency of the encoder", verb("emergency", "encoder", 0x5000), AT_ONCE),
    Cause("load encoder slips", verb("jump", "encoder", 0.02), AT_ONCE, unseen=NOT_RUNNING),
    Cause("load encoder the wrong way round", verb("scale", "encoder", -1.0), MOTION, unseen=AT_REST),
    Cause("torque sensor overloaded", verb("overload"), AT_ONCE),
    Cause("torque sensor's cable broken", verb("broken_cable"), AT_ONCE),
    Cause("host stalls for 30 ms", stall, 0.0, Expected.GO_ON),
)
