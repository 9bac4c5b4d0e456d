"""Is this machine, this bus and this bench fit for a run? One check a file; CHECKS is the list, in the order shown."""

from __future__ import annotations

from collections.abc import Callable

from rig.bench import Bench
from rig.doctor.bus_load import check_bus_load
from rig.doctor.calibration import check_calibration
from rig.doctor.clock import check_clock
from rig.doctor.devices import check_devices
from rig.doctor.disk import check_disk
from rig.doctor.finding import Finding
from rig.doctor.governor import check_governor
from rig.doctor.latch_skew import check_latch_skew
from rig.doctor.latency import check_latency
from rig.doctor.scheduling import check_scheduling

CHECKS: tuple[Callable[[Bench], list[Finding]], ...] = (
    check_scheduling,
    check_latency,
    check_governor,
    check_clock,
    check_disk,
    check_bus_load,
    check_calibration,
    check_latch_skew,
    check_devices,
)
