"""What a procedure would do on a bench, for a person. Writes nothing, moves nothing."""

from __future__ import annotations

import math

from rig.bench import Bench
from rig.campaign.swing import ORDER_2, swing
from rig.control.stability import MOST
from rig.core.procedure import Procedure
from rig.core.units import DEG, RPM
from rig.guard import Guard
from rig.refusals import TOLD, loop_of, margins
from rig.runfile.room import rows_bytes


def plan_lines(bench: Bench, procedure: Procedure) -> list[str]:
    """What a dry run prints: travel, speed, torque, energy, duration, bytes, and the margins to every limit."""
    envelope = procedure.envelope(bench.setting(lambda text: None))
    rows = int(envelope.duration * bench.file.loop.rate)
    size = rows_bytes(rows) / 1e6
    lines = [
        f"procedure   {procedure.title()} on {bench.file.name}{'' if bench.by_person else ' (SIMULATED)'}",
        f"duration    at most {envelope.duration:.1f} s of rig time, {rows} rows, about {size:.0f} MB",
        f"stored      at most {stored_energy(bench, procedure, shaft_torque(bench, procedure)):.4f} J in motion and "
        "wound up in the gear",
    ]
    for what, asked, limit, unit, scale in margins(bench, procedure):
        # the loop is clamped there: what it will need is known only once it runs
        if what == "torque" and asked <= limit:
            lines.append(f"{what:11s} at most {asked * scale:g} {unit} (clamped), limit {limit * scale:g} {unit}")
            continue
        lines.append(f"{what:11s} {asked * scale:g} of {limit * scale:g} {unit}, {margin(asked / limit)}")
    if (loop := loop_of(bench, procedure)) is not None:
        lines.append(f"gains       {gains_words(loop.margin(bench.gains))}, by the declared gear")
    what, left = tightest(bench, procedure)
    said = f"{100 * left:.0f} % of its limit left" if left >= 0 else margin(1 - left)
    lines += [f"tightest    {what}: {said}", f"guard       {guard_words(bench, procedure)}"]
    return [*lines, *procedure.remarks(bench.setting(lambda text: None))]


def guard_words(bench: Bench, procedure: Procedure) -> str:
    """At what the guard will end this run: often long before the limits of the bench, which hold for every run."""
    setting = bench.setting(lambda text: None)
    guard = Guard(bench.limits, procedure.envelope(setting), setting.ratio)
    shaft = "" if guard.shaft_torque is None else f", {guard.shaft_torque:.4g} N·m at the shaft"
    return (
        f"ends this run beyond {guard.travel / DEG:.1f} deg of the motor from its start, "
        f"{guard.limits.speed / RPM:g} rpm{shaft}"
    )


def gains_words(gain: float) -> str:
    """By what all gains may be multiplied before the loop swings up by itself."""
    if gain <= 1.0:
        return "the loop would swing up by itself"
    return f"the loop comes to rest with {'over' if gain >= MOST else 'up to'} {gain:.3g} times these"


def margin(share: float) -> str:
    """What is left of a limit of which `share` is asked for, in words; beyond it how many times the limit that is."""
    return f"margin {100 * (1 - share):.0f} %" if share <= 1 else f"{share:.3g} times the limit"


def shaft_torque(bench: Bench, procedure: Procedure) -> float:
    """What the torque sensor is expected to carry at most [N·m], nothing hung on the output: what a lock test winds up
    or torque steps shake, or the swing of order 2 at the highest speed.
    """
    envelope = procedure.envelope(bench.setting(lambda text: None))
    if math.isfinite(envelope.shaft_torque):
        return envelope.shaft_torque
    if procedure.output_locked:
        return 0.0
    return swing(bench.declared_gear, ORDER_2, envelope.speed)


def stored_energy(bench: Bench, procedure: Procedure, shaft_torque: float) -> float:
    """J stored at most: in motion, and wound up in the gear under `shaft_torque` N·m."""
    gear = bench.file.gear
    inertia = gear.J_m + (0.0 if procedure.output_locked else gear.J_l / gear.N**2)
    speed = procedure.envelope(bench.setting(lambda text: None)).speed
    return float(0.5 * inertia * speed**2 + 0.5 * shaft_torque**2 / gear.K)


def tightest(bench: Bench, procedure: Procedure) -> tuple[str, float]:
    """Which limit the run comes nearest to, and the share of it that is left; below zero it is broken. Motor torque is
    none of them unless it is broken: the loop is held at its limit, and what it will need is known only once it runs.
    """
    asked_for = margins(bench, procedure)
    left = {what: 1 - asked / limit for what, asked, limit, _, _ in asked_for if what != "torque" or asked > limit}
    if bench.limits.shaft_torque is not None:
        left.setdefault("shaft", 1 - shaft_torque(bench, procedure) / bench.limits.shaft_torque)
    nearest = min(left, key=lambda what: left[what])
    return TOLD[nearest], left[nearest]
