"""What each act does, once it is accepted. What raises HdrigError is told to the page as refused, any other error
as a defect of ours."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from rig.bench import Bench, ClockName, read
from rig.campaign.clear_of_resonance import refuse_resonance
from rig.campaign.run import to_bare
from rig.core.errors import UsageError
from rig.core.operator import FreeOutput, LockOutput
from rig.core.procedure import Procedure
from rig.doctor import CHECKS
from rig.doctor.devices import check_devices, identified
from rig.doctor.disk import check_disk
from rig.doctor.finding import Finding, Health
from rig.parameters.read import make
from rig.procedures import CATALOGUE, procedure_class
from rig.procedures.jog import Jog
from rig.session import Session
from rig.station.analysis import ANALYSE, Analysis
from rig.station.campaigns import conduct_plan
from rig.station.station import Job, Station


def connect(station: Station, message: Mapping[str, Any]) -> None:
    """Open the bench; nothing is energised. On the twin the clock is the wall's unless told otherwise."""
    bench = read(str(message.get("bench", "")), [str(x) for x in message.get("overrides") or []])
    station.busy(f"connecting {bench.file.name}")
    clock: ClockName = "virtual" if message.get("clock") == "virtual" else "wall"
    session = Session(bench, clock, station.root, station.panel, observer=station.teller)
    try:
        station.stack.enter_context(session)
    except Exception:
        station.disconnect()
        raise
    station.connected(session)
    station.status.bench = {
        "name": bench.file.name, "source": str(message.get("bench", "")), "simulated": session.simulated,
        "gear": bench.file.gear.serial,
        "ratio": bench.file.gear.N, "rate": bench.file.loop.rate, "clock": clock,
        "overrides": [str(x) for x in message.get("overrides") or []],
        "page_lost": bench.file.console.page_lost, "page_lost_s": bench.file.console.page_lost_s,
        "torque_sensor": session.instruments.torque_sensor is not None,
        "devices": {name: " ".join(part for part in who if part) for name, who in session.identities.items()},
    }  # fmt: skip
    station.status.bench["limits"] = _limits(session)
    station.teller.say("state", f"connected {bench.file.name}: {bench.source}")


def _limits(session: Session) -> dict[str, float | None]:
    """What the page draws its scales to, in the bench file's own units; None where there is nothing to limit."""
    lim = session.bench.file.limits
    shaft = lim.shaft_torque if session.instruments.torque_sensor is not None else None
    keys = ("speed_rpm", "torque", "following_deg", "travel_turns")
    return {**{key: getattr(lim, key) for key in keys}, "shaft_torque": shaft}


def disconnect(station: Station, message: Mapping[str, Any]) -> None:
    """Torque off, devices let go."""
    station.disconnect()


def check(station: Station, message: Mapping[str, Any]) -> None:
    """The doctor."""
    session = station.session
    bench = session.bench if session is not None else read(str(message.get("bench", "twin")))
    station.status.checks = []
    for one in CHECKS:
        found = _found(one, bench, station)
        station.status.checks += [
            {"name": f.what, "ok": f.health is not Health.BAD, "health": str(f.health), "text": f.sentence}
            for f in found
        ]
        station.told()
        station.watch()
    if all(c["ok"] for c in station.status.checks):
        station.ready()


def _devices(session: Session) -> list[Finding]:
    found = identified(session.identities)
    trouble = session.instruments.causes()
    return [*found, Finding("devices", Health.BAD, trouble)] if trouble else found


def _found(one: Callable[[Bench], list[Finding]], bench: Bench, station: Station) -> list[Finding]:
    """Room where this station's runs go; of devices that are open already only what they said of themselves."""
    if one is check_disk:
        return check_disk(bench, station.root)
    if one is check_devices and station.session is not None:
        return _devices(station.session)
    return one(bench)


def prove(station: Station, message: Mapping[str, Any]) -> None:
    """One turn forth and back."""
    station.need().prove()


def tare(station: Station, message: Mapping[str, Any]) -> None:
    """The unloaded torque sensor's zero; the proof first where there is none."""
    station.teller.say("finding", station.need().tare())


def start(station: Station, message: Mapping[str, Any]) -> None:
    """Proof where there is none, pin in or out where it has to be, the run, its analysis."""
    session = station.need()
    procedure = _procedure(message)
    station.busy(f"run {procedure.title()}")
    session.check(procedure)
    refuse_resonance(session.bench, procedure)
    _prepare(station, session, procedure)
    _run(station, session, procedure, str(message.get("note") or ""))


def jog(station: Station, message: Mapping[str, Any]) -> None:
    """A bounded turn; it is a run like any other, without figures."""
    session = station.need()
    given = {key: message[key] for key in ("turns", "speed_rpm") if message.get(key) is not None}
    procedure = make(Jog, given, "jog")
    station.busy(f"jog {procedure.turns:+g} turns at {procedure.speed_rpm:g} rpm")
    session.check(procedure)
    _prepare(station, session, procedure)
    session.run(procedure)


def _procedure(message: Mapping[str, Any]) -> Procedure:
    name = str(message.get("procedure", "")).replace("_", "-")
    if name not in CATALOGUE:
        raise UsageError(f"no procedure called '{name}'; expected one of {', '.join(CATALOGUE)}")
    return make(procedure_class(name), message.get("parameters") or {}, name)


def _prepare(station: Station, session: Session, procedure: Procedure) -> None:
    """What `hdrig run` does before: the proof, the pin; of a change nobody could show it is first made sure."""
    for change in to_bare(session.rigging, station.pending) if session.unsure else ():
        station.teller.say("finding", session.change(change))
    if session.rigging.output_locked and not procedure.output_locked:
        station.teller.say("finding", session.change(FreeOutput()))
    if procedure.closes_loop and session.proof is None:
        session.prove()
        station.told()
    if procedure.output_locked and not session.rigging.output_locked:
        station.teller.say("finding", session.change(LockOutput()))
    for remark in procedure.remarks(session.bench.setting(lambda text: None)):
        station.teller.say("note", remark)


def _run(station: Station, session: Session, procedure: Procedure, note: str) -> None:
    session.note = note
    try:
        done = session.run(procedure)
    finally:
        session.note = ""
    if done.ending.status == "completed" and not procedure.answers:
        if station.analysis is not None:
            station.analysis.end()
        station.analysis = Analysis(done.folder, ANALYSE)


def reset(station: Station, message: Mapping[str, Any]) -> None:
    """The explicit act that leaves a fault. Energises nothing."""
    station.need().reset()


def note(station: Station, message: Mapping[str, Any]) -> None:
    """Into the next run's events."""
    station.note(str(message.get("text", "")))


def answer(station: Station, message: Mapping[str, Any]) -> None:
    """Nothing is asked while nothing is carried out."""


JOBS: dict[str, Job] = {
    "connect": connect,
    "disconnect": disconnect,
    "check": check,
    "prove": prove,
    "tare": tare,
    "start": start,
    "campaign": conduct_plan,
    "jog": jog,
    "reset": reset,
    "note": note,
    "answer": answer,
}
