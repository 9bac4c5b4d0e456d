"""One fault in one phase, and whether the program did what it has to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

from rig.core.errors import Exit, HdrigError, NotReady
from rig.drill.canopen_rig import CanopenRig
from rig.drill.cause import Cause, Expected
from rig.drill.phase import Phase
from rig.drill.rig import DrillRig
from rig.supervisor import Act, State

PERIODS = 3  # control periods allowed beside the declared detection time
AFTERWARDS = 0.5  # s watched when the run is over: nothing may come back, and the drive's own watchdog has acted
QUIET = 1e-3  # N·m at the motor that count as none


@dataclass(frozen=True)
class Outcome:
    """What was seen. `reaction` is from the cause to the last torque commanded [s], 0 when none was."""

    cause: Cause
    phase: str
    ended: str  # status of the run, or "refused"
    reason: str
    reaction: float
    allowed: float  # s
    rows: int
    wrong: tuple[str, ...]  # what was not as it has to be, in words; empty when all was

    @property
    def passed(self) -> bool:
        """All was as it has to be."""
        return not self.wrong


def drill(cause: Cause, phase: Phase, made: Callable[[], DrillRig] = CanopenRig) -> Outcome:
    """Strike, and look, on a rig `made` for it. Raises nothing of the run's own."""
    rig = made()
    struck: list[float] = []

    def strike() -> None:
        struck.append(rig.wire.now())
        cause.strike(rig)

    try:
        phase.arrange(rig, strike)
        ended, reason = _run(rig, phase)
        since = struck[0] if struck else rig.wire.now()
        commands = rig.torque_commands(since)
        reaction = max(commands, default=since) - since
        allowed = cause.detection + PERIODS * rig.bench.setting(lambda text: None).period + 1e-9
        over = rig.wire.now()
        wrong = [*as_expected(cause, phase, ended), *_in_time(cause, phase, reaction, allowed)]
        wrong += _rows_kept(rig, since) if phase.name not in ("idle", "enabling") else []
        rig.wire.wait_until(over + AFTERWARDS)
        wrong += _stays_off(rig, over, ended)
        return Outcome(cause, phase.name, ended, reason, reaction, allowed, len(rig.rows.rows), tuple(wrong))
    finally:
        rig.close()


def _run(rig: DrillRig, phase: Phase) -> tuple[str, str]:
    try:
        ending = rig.run(phase.procedure)
    except HdrigError as why:
        return "refused", str(why)
    if ending.exit is Exit.STOPPED:
        return "stopped", ending.reason
    return ending.status, ending.reason


def as_expected(cause: Cause, phase: Phase, ended: str) -> list[str]:
    """What is wrong with a run that `ended` so, in words; nothing where that is how it has to end."""
    good = {"completed", "stopped"}
    if cause.expected is Expected.GO_ON:
        # before a run starts, being refused is always right; to trip on what is harmless is not
        early = ended == "refused" and phase.name in ("idle", "enabling")
        fine = ended in good or early or phase.name in cause.or_stops
        return [] if fine else [f"the run was {ended}, expected to go on"]
    if phase.name in cause.unseen:
        return []
    return [] if ended in ("tripped", "refused") else [f"the run was {ended}, expected a trip"]


def _in_time(cause: Cause, phase: Phase, reaction: float, allowed: float) -> list[str]:
    if cause.expected is Expected.GO_ON or phase.name in cause.unseen or phase.name in ("idle", "enabling"):
        return []
    if reaction <= allowed:
        return []
    return [f"torque was commanded for {reaction * 1e3:.1f} ms after the cause, {allowed * 1e3:.1f} ms allowed"]


def _rows_kept(rig: DrillRig, since: float) -> list[str]:
    """Every row before the cause is there, one a period."""
    before = [row[0].t for row in rig.rows.rows if rig.instruments.started + row[0].t < since]
    gaps = [b - a for a, b in pairwise(before) if b - a > rig.longest_row]
    if not before:
        return ["no rows from before the cause"]
    return [f"{len(gaps)} gaps in the rows before the cause"] if gaps else []


def _stays_off(rig: DrillRig, over: float, ended: str) -> list[str]:
    wrong = []
    if rig.torque_commands(over):
        wrong.append("torque was commanded after the run was over")
    if rig.energised:
        wrong.append("the drive is still energised half a second later")
    rig.assembly.world.advance_to(rig.wire.now())
    if abs(rig.assembly.world.truth().tau_m) > QUIET:
        wrong.append(f"the motor still gives {rig.assembly.world.truth().tau_m:+.3f} N·m half a second later")
    if ended == "tripped":
        wrong += _latched(rig)
    return wrong


def _latched(rig: DrillRig) -> list[str]:
    if rig.supervisor.state is not State.FAULT:
        return [f"the state is {rig.supervisor.state}, expected fault"]
    for act in (Act.CHECK, Act.ENABLE, Act.RUN):
        try:
            rig.supervisor.act(act)
        except NotReady:
            continue
        return [f"it let itself {act} without a reset"]
    return []
