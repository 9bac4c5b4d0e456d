"""A first bench file from what answers on a bus: what devices know is in it, the rest is assumed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from rig.bench import BENCHES, toml_value
from rig.core.clock import WallClock
from rig.core.errors import UsageError

if TYPE_CHECKING:
    from drivers.scan import Found, SerialPort

TEMPLATE = "twin-canopen"
NO_SYNC = "twin-odrive"  # nothing latches together: other gains of time
SLOW = {"slcan": "twin-slcan"}  # 22 characters a frame: 250 Hz, with the gains and the latch lead of that rate
HEAD = (
    ' A first bench file, written from what answered on the bus. Numbers the devices told say from = "measured";',
    " all others belong to the rig of the paper and are to be replaced by yours.",
)
SECTIONS = {"drive": "motor", "load_encoder": "load_encoder", "torque_sensor": "torque_sensor"}


def scan_ports() -> list[SerialPort]:
    """Serial ports of this machine."""
    from drivers.scan import serial_ports

    return serial_ports()


def adapter_options(assignments: Iterable[str]) -> dict[str, Any]:
    """`name=value` as python-can is to be told it. Raises UsageError."""
    options: dict[str, Any] = {}
    for assignment in assignments:
        name, equals, value = assignment.partition("=")
        if not (name.strip() and equals and value.strip()):
            raise UsageError(f"--option {assignment}: expected name=value, for example port=29536")
        options[name.strip()] = toml_value(value)
    return options


def scan_bus(interface: str, channel: str, bitrate: int, options: Mapping[str, Any]) -> list[Found]:
    """Nodes that answer. Raises NotReady when the bus cannot be opened or is lost."""
    from drivers.bus import Bus
    from drivers.scan import scan

    bus = Bus("scan", interface, channel, WallClock(), {**options, "bitrate": bitrate})
    bus.open()
    try:
        return scan(bus)
    finally:
        bus.close()


def first_bench(
    interface: str, channel: str, bitrate: int, nodes: Sequence[Found], options: Mapping[str, Any] | None = None
) -> str:
    """The text of a bench file for these nodes. Devices of a kind that did not answer are left out."""
    import tomlkit

    from drivers import NO_PROFILE, PROFILES

    own = NO_SYNC if any(node.profile == NO_PROFILE for node in nodes) else SLOW.get(interface, TEMPLATE)
    document: Any = tomlkit.parse((BENCHES / f"{own}.toml").read_text(encoding="utf-8"))
    bench: Any = tomlkit.document()
    twin = any(node.identity.simulated for node in nodes)
    for line in (*HEAD, *([" SIMULATED: the devices say that they are the twin's."] if twin else [])):
        bench.add(tomlkit.comment(line.strip()))
    for key, value in document.items():
        bench[key] = value
    bench["name"] = "first"
    bench["bus"]["rig"].update({"interface": interface, "channel": channel})
    bench["bus"]["rig"]["bitrate"]["value"] = bitrate
    bench["bus"]["rig"].pop("options", None)  # of the twin's adapter
    if options:
        given = tomlkit.inline_table()
        given.update(options)
        bench["bus"]["rig"]["options"] = given
    if not twin:
        bench.pop("hand")  # only a twin's: a bench of real devices is refused with one
        bench["gear"]["serial"] = "UNNAMED"
    found = {PROFILES[node.profile]: node for node in nodes if node.profile in PROFILES}
    for role in SECTIONS:
        bench["devices"].pop(role, None)
    for (role, kind), node in found.items():
        _add_device(bench, role, kind, node)
    return tomlkit.dumps(bench)


def _add_device(bench: Any, role: str, kind: str, node: Found) -> None:
    """Where it is in [devices], and what it told of itself in the section of its numbers."""
    import tomlkit

    device = tomlkit.table()
    device.update({"type": kind, "bus": "rig", "node": node.number})
    device.comment(" ".join(part for part in node.identity if part))
    bench["devices"][role] = device
    plate = dict(node.plate)
    if step := plate.pop("rated_step", 0.0):
        device["rated_step"] = step
    for key, told in plate.items():
        quantity = bench[SECTIONS[role]][key]
        if told:
            value = told if key == "torque_rated" else round(told)
            quantity.update({"value": value, "from": "measured", "note": "told by the device"})
