"""The device that fills a role on a bench: its class, and what it is told of the bench."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rig.config.bench_file import BenchFile
from rig.core.devices import Device, Drive, Encoder, TorqueSensor
from rig.core.errors import UsageError
from rig.core.nearest import nearest
from rig.guard import Limits

if TYPE_CHECKING:
    from drivers.wiring import Place

ROLES: dict[str, Any] = {"drive": Drive, "load_encoder": Encoder, "torque_sensor": TorqueSensor}


def device_class(kind: str, where: str) -> Callable[..., Device]:
    """The class behind a device type. Raises UsageError naming the nearest that exists."""
    import drivers
    import sim

    catalogue: dict[str, str] = {**sim.CATALOGUE, **drivers.CATALOGUE}
    if kind not in catalogue:
        raise UsageError(f"{where} = '{kind}': no such device; {nearest(kind, catalogue)}")
    module, _, name = catalogue[kind].partition(":")
    found: Callable[..., Device] = getattr(importlib.import_module(module), name)
    return found


def place_of(role: str, f: BenchFile, limits: Limits) -> Place:
    """What the driver of `role` is told of the bench."""
    from drivers.wiring import Place

    side = f.load_encoder if role == "load_encoder" else f.motor
    return Place(
        role=role,
        options=getattr(f.devices, role).options(),
        counts_per_turn=side.counts_per_turn if side else 0,
        torque_rated=f.motor.torque_rated,
        torque_limit=min(f.motor.torque_limit, f.limits.torque),
        speed_limit=limits.speed / (f.gear.N if role == "load_encoder" else 1.0),
        following=limits.following + limits.following_time * limits.speed,
        range=f.torque_sensor.range if f.torque_sensor else 0.0,
        period=1.0 / f.loop.rate,
        stale=limits.stale,
    )
