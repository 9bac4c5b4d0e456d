"""Where the devices of a bench file are: on its own buses, no two in one place; and what their sections may hold."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from rig.config import BenchFile, DeviceSection
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


def check_keys(source: str, role: str, section: DeviceSection, known: Sequence[str]) -> None:
    """Raises UsageError: a key of another kind of device, which would be passed over in silence."""
    for key in sorted(section.model_fields_set - {"type", *known}):
        takes = ", ".join(("type", *known))
        raise UsageError(f"{source}: devices.{role}.{key} means nothing to a {section.type}; it has {takes}")
