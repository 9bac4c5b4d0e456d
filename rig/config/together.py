"""What a bench file must hold together: devices on its own buses, no two in one place, their sections, their times."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from rig.config.bench_file import BenchFile
from rig.config.sections import DeviceSection
from rig.core.errors import UsageError


def check_places(source: str, f: BenchFile) -> None:
    """Raises UsageError: a bus that the file has not, or two devices that would answer each other's questions."""
    named = {role: device for role, device in f.devices if device is not None}
    for role, device in named.items():
        if device.bus is not None and device.bus not in f.bus:
            known = ", ".join(f.bus) or "none"
            raise UsageError(f"{source}: devices.{role}.bus = '{device.bus}': no such bus; the bench file has {known}")
    nodes = Counter((d.bus, d.node) for d in named.values() if d.bus is not None and d.node is not None)
    for (bus, node), count in nodes.items():
        if count > 1:
            raise UsageError(
                f"{source}: two devices are node {node} on bus '{bus}'; every node has a number of its own"
            )
    for port, count in Counter(d.port for d in named.values() if d.port is not None).items():
        if count > 1:
            raise UsageError(f"{source}: two devices are on port {port}; every serial device has a port of its own")


def check_together(source: str, f: BenchFile) -> None:
    """What no single key shows. Raises UsageError."""
    devices = [d for d in (f.devices.drive, f.devices.load_encoder, f.devices.torque_sensor) if d is not None]
    if len({d.type.startswith("twin.") for d in devices}) > 1:
        mixed = ", ".join(d.type for d in devices)
        raise UsageError(f"{source}: real and simulated devices on one bench ({mixed}): never silently simulated")
    if devices[0].type.startswith("twin.") and f.twin is None:
        raise UsageError(f"{source}: devices of the twin need a [twin] section")
    for role in ("load_encoder", "torque_sensor"):
        if getattr(f.devices, role) and getattr(f, role) is None:
            raise UsageError(f"{source}: devices.{role} needs a [{role}] section")
    if f.twin and f.twin.watchdog * f.loop.rate < 3:
        raise UsageError(
            f"{source}: the drive's watchdog of {f.twin.watchdog:g} s is under three periods of the loop "
            f"({3 / f.loop.rate:g} s at {f.loop.rate:g} Hz)"
        )
    for device in devices:
        if device.watchdog is not None and device.watchdog * f.loop.rate < 3:
            raise UsageError(
                f"{source}: a watchdog of {device.watchdog:g} s is under three periods of the loop "
                f"({3 / f.loop.rate:g} s at {f.loop.rate:g} Hz)"
            )
    watchdog, stale = f.devices.drive.watchdog, f.limits.stale_s
    if watchdog is not None and watchdog <= stale:
        raise UsageError(
            f"{source}: devices.drive.watchdog = {watchdog:g} s is no longer than limits.stale_s = {stale:g} s: "
            "the drive would take the torque off before the guard does and nobody would know why; expected a longer "
            "watchdog, or a shorter stale_s"
        )
    if f.loop.latch_lead * f.loop.rate >= 1:
        raise UsageError(
            f"{source}: loop.latch_lead = {f.loop.latch_lead:g} s is no shorter than the period of "
            f"{1 / f.loop.rate:g} s: devices would have to answer before the tick they are read in"
        )
    check_places(source, f)
    if f.torque_sensor and f.limits.shaft_torque > f.torque_sensor.range:
        raise UsageError(
            f"{source}: limits.shaft_torque = {f.limits.shaft_torque:g} N·m is beyond the torque sensor's "
            f"range of {f.torque_sensor.range:g} N·m"
        )


def check_keys(source: str, role: str, section: DeviceSection, known: Sequence[str]) -> None:
    """Raises UsageError: a key of another kind of device, which would be passed over in silence."""
    for key in sorted(section.model_fields_set - {"type", *known}):
        takes = ", ".join(("type", *known))
        raise UsageError(f"{source}: devices.{role}.{key} means nothing to a {section.type}; it has {takes}")
