"""Campaigns on random twins in memory: the program's own procedures, loop, guard and devices, without a recorder."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from rig.bench import Bench, read
from rig.core.operator import FreeOutput, LockOutput
from rig.core.procedure import Procedure
from rig.core.sample import Sample
from rig.guard import Guard
from rig.instruments import Instruments
from rig.loop import Loop
from rig.procedures.constant_torque import ConstantTorque
from rig.procedures.friction import Friction
from rig.procedures.kinematic_error import KinematicError
from rig.procedures.stiffness_lock import StiffnessLock
from rig.process.interrupts import Interrupts
from rig.supervisor import Act, Supervisor
from rig.timing.ticks import LoopTiming

Array = npt.NDArray[np.float64]
SPREAD = 0.3  # of every parameter, either way
SCALED = ("gear.J_m", "gear.J_l", "gear.K", "gear.B_m", "gear.B_ml", "gear.B_l", "gear.B_sp", "twin.tau_c", "twin.F_cl")
COLUMNS = ("t", "theta_m", "theta_l", "tau_m", "tau_l", "tau_ask", "theta_ref", "flags")

SLOW = KinematicError(cycles=1.0)  # of the paper's two and more: 100 s
LOCK = StiffnessLock(cycles=1, rate=1.5, rates=(1.0,))  # of three cycles and three rates: 60 s
STAIRS = Friction(speeds_rpm="20,50,100,200,300,500", seconds=2.0, breakaways=1)  # without 5 and 10 rpm: 90 s


def at(rpm: float) -> ConstantTorque:
    """As the paper's, 60 turns; it settles for 2 s of the usual 5."""
    return ConstantTorque(speed_rpm=rpm, settle=2.0)


PLANS: dict[str, tuple[Procedure, ...]] = {
    "paper": (SLOW, at(120.0), at(300.0), at(310.0), at(500.0), LOCK, STAIRS),
    "complete": (
        *(SLOW, STAIRS, LOCK),
        *(at(rpm) for rpm in (60.0, 120.0, 200.0, 300.0, 400.0, 500.0, -120.0, -200.0, -300.0, -400.0, -500.0)),
        LOCK,
    ),
}


@dataclass(frozen=True)
class MemoryRun:
    """What a run folder holds, without the folder."""

    name: str
    manifest: dict[str, Any]
    columns: dict[str, Array]
    misfits: tuple[str, ...] = ()

    def column(self, name: str) -> Array | None:
        return self.columns.get(name)

    def has(self, name: str) -> bool:
        return name in self.columns

    @property
    def ratio(self) -> float:
        return float(self.manifest["gear"]["ratio"])

    @property
    def procedure(self) -> str:
        return str(self.manifest["procedure"])

    @property
    def conditions(self) -> dict[str, Any]:
        return dict(self.manifest["conditions"])

    @property
    def declared(self) -> dict[str, Any]:
        return dict(self.manifest["declared"])


class Rows:
    """A sink that keeps numbers only."""

    def __init__(self) -> None:
        self.rows: list[tuple[float, ...]] = []

    def put(self, sample: Sample, tau_ask: float, tau_applied: float, theta_ref: float) -> None:
        self.rows.append(
            (sample[0], sample[1], sample[2], sample[4], sample[5], tau_ask, theta_ref, float(sample.flags))
        )

    def check(self) -> None:
        pass

    def columns(self) -> dict[str, Array]:
        table = np.array(self.rows, dtype=np.float64).T
        return {name: np.ascontiguousarray(values) for name, values in zip(COLUMNS, table, strict=True)}


def random_bench(number: int) -> Bench:
    """The twin with every parameter and every order drawn within ±30 %, all phases anew; the same for one number."""
    generator = np.random.default_rng([number, 20010123])
    plain = read("twin").file
    values = {name: _value(plain, name) * float(generator.uniform(1 - SPREAD, 1 + SPREAD)) for name in SCALED}
    values["twin.tau_s"] = values["twin.tau_c"] * float(generator.uniform(1.2, 1.8))
    assert plain.twin is not None
    orders = np.asarray(plain.twin.kinematic_error.C_deg) * generator.uniform(1 - SPREAD, 1 + SPREAD, 15)
    phases = generator.uniform(-180.0, 180.0, 15)
    assignments = [f"{name}={value!r}" for name, value in values.items()]
    assignments += [f"twin.kinematic_error.C_deg={orders.tolist()}", f"twin.kinematic_error.psi_deg={phases.tolist()}"]
    return read("twin", [*assignments, f"twin.seed={number + 1}"])


def _value(file: Any, name: str) -> float:
    section, key = name.split(".")
    return float(getattr(getattr(file, section), key))


def take(bench: Bench, plan: Sequence[Procedure]) -> tuple[list[MemoryRun], float, list[str]]:
    """The plan's runs on one twin in one session, the motor encoder's zero [rad], and what did not complete, in words.

    The procedures are told the nominal rig, as the manifests are: what is true of this one is in the plant alone.
    """
    told, rig = read("twin"), bench.open("virtual")
    rig.connect()
    runs, failed = [], []
    for number, procedure in enumerate(plan):
        run, status = _one(told, rig, procedure, f"{number:02d}-{procedure.title()}")
        runs.append(run)
        if status != "completed":
            failed.append(status)
    encoder = rig.drive.encoder  # type: ignore[attr-defined]
    rig.close()
    return [r for r in runs if r.manifest["status"] == "completed"], encoder.zero + 0.5 * encoder.step, failed


def _one(told: Bench, rig: Instruments, procedure: Procedure, name: str) -> tuple[MemoryRun, str]:
    supervisor, sink, setting = Supervisor(), Rows(), told.setting(lambda text: None)
    supervisor.act(Act.CONNECT)
    supervisor.act(Act.CHECK)
    if procedure.output_locked and rig.operator is not None:
        rig.operator.make(LockOutput())
    guard = Guard(told.limits, procedure.envelope(setting), setting.ratio)
    timing = LoopTiming(setting.period, virtual=True)
    ending = Loop(rig, supervisor, guard, sink, Interrupts(), timing).run(procedure, setting)
    if procedure.output_locked and rig.operator is not None:
        rig.operator.make(FreeOutput())
    manifest = {
        **told.manifest(), "procedure": procedure.name, "conditions": procedure.conditions(), "status": ending.status,
    }  # fmt: skip
    return MemoryRun(name, manifest, sink.columns()), f"{name}: {ending.reason}" if ending.status != "completed" else (
        "completed"
    )
