"""What a bench does not allow a procedure, told before anything moves."""

from __future__ import annotations

import math
from typing import Any

from rig.bench import Bench
from rig.control.stability import Loop
from rig.control.winding import PER_TICK
from rig.core.errors import NotReady, UsageError
from rig.core.operator import Rigging
from rig.core.procedure import Procedure
from rig.core.sample import Mode
from rig.core.units import DEG, RPM
from rig.parameters.read import make
from rig.parameters.told import Told, told

TOLD = {
    "travel": "motor travel",
    "speed": "motor speed",
    "torque": "motor torque",
    "shaft": "shaft torque",
    "loop": "the position loop",
}
LIMITS = {
    "travel": "limits.travel_turns",
    "speed": "limits.speed_rpm",
    "torque": "the smaller of limits.torque and motor.torque_limit",
    "shaft": "limits.shaft_torque, what the torque sensor may carry",
    "loop": f"{PER_TICK:g} rad a tick of loop.rate, beyond which it shakes",
}
LONGEST = 31 * 86400.0  # s
LARGEST = 1e100  # in any unit: its square is still a number


def refuse_rigging(rigging: Rigging, procedure: Procedure) -> None:
    """Raises NotReady when the lock pin is not as the procedure needs it."""
    if procedure.output_locked is not rigging.output_locked:
        words = {True: "locked", False: "free"}
        raise NotReady(
            f"{procedure.title()} needs a {words[procedure.output_locked]} output, "
            f"and it is {words[rigging.output_locked]}"
        )


def refuse_endless(bench: Bench, procedure: Procedure) -> None:
    """Raises UsageError when what the procedure would do is no finite number, or longer than a month."""
    if what := _endless(bench, procedure):
        raise UsageError(
            f"{procedure.title()} with {_culprit(bench, procedure)} is endless or immeasurably fast: {what}, expected "
            f"above 0 and at most {LONGEST:.0f} s ({LONGEST / 86400:g} days)"
        )


def _endless(bench: Bench, procedure: Procedure) -> str:
    """What of it is no finite number, or how long it would take, in words; "" where it comes to an end."""
    try:
        envelope = procedure.envelope(bench.setting(lambda text: None))
    except (OverflowError, ZeroDivisionError, UsageError):
        return "how long it would take is no number"
    if not all(abs(x) < LARGEST for x in (envelope.duration, envelope.travel, envelope.speed, envelope.torque)):
        return "what it would do is no finite number of s"
    return "" if 0 < envelope.duration < LONGEST else f"it would take {envelope.duration:g} s"


def _culprit(bench: Bench, procedure: Procedure) -> str:
    """The parameter without which it would come to an end, with its unit and its default; else all that were given."""
    given = [one for one in told(type(procedure)) if getattr(procedure, one.name) != one.default]
    alone = [one for one in given if _ends_with_default(bench, procedure, one)]
    return ", ".join(
        f"{one.name} = {one.written(getattr(procedure, one.name))} (by default {one.written(one.default)})"
        for one in alone or given
    )


def _ends_with_default(bench: Bench, procedure: Procedure, one: Told) -> bool:
    try:
        return not _endless(bench, make(type(procedure), _parameters(procedure) | {one.name: one.default}, ""))
    except UsageError:  # the others do not go with it
        return False


def _parameters(procedure: Procedure) -> dict[str, Any]:
    return {one.name: getattr(procedure, one.name) for one in told(type(procedure))}


def refuse_mode(bench: Bench, procedure: Procedure) -> None:
    """Raises NotReady when the drive is to close the loop itself, and the procedure has no reference to give it."""
    if bench.mode is not Mode.TORQUE and not procedure.has_reference:
        raise NotReady(
            f"{procedure.title()} asks for torques and has no reference throughout: the drive cannot be given "
            f'{bench.mode} setpoints; set control.mode = "torque"'
        )


def refuse_beyond_limits(bench: Bench, procedure: Procedure, given: str = "torque") -> None:
    """Raises NotReady when the procedure asks for more than the bench allows, or for a loop that cannot hold it; what
    was `given`, by its name in TOLD, is told before what follows from it."""
    envelope = procedure.envelope(bench.setting(lambda text: None))
    reserved = ("shaft",) if procedure.output_locked else ("speed", "shaft")
    for what, asked, limit, unit, scale in sorted(margins(bench, procedure), key=lambda margin: margin[0] != given):
        if asked > limit:
            wanted, allowed = f"{asked * scale:g} {unit}", f"{limit * scale:g} {unit}"
            said = envelope.loop_by if what == "loop" else envelope.reserve if what in reserved else ""
            why = f" ({said})" if said else ""
            raise NotReady(
                f"{procedure.title()} asks for up to {wanted} of {TOLD[what]}{why}, the bench allows {allowed}: "
                f"{LIMITS[what]}"
            )
    refuse_swinging_up(bench, procedure)


def refuse_swinging_up(bench: Bench, procedure: Procedure) -> None:
    """Raises NotReady when the host's loop with the bench's gains would swing up by itself on its declared gear."""
    if swings_up(bench, procedure):
        g, gear, loop = bench.gains, bench.file.gear, bench.file.loop
        raise NotReady(
            f"{procedure.title()}: the position loop would swing up by itself with Kp {g.Kp:g} N·m/rad, Ki {g.Ki:g} "
            f"N·m/(rad·s), Kd {g.Kd:g} N·m·s/rad on the declared gear (J_m {gear.J_m:g} kg·m², J_l {gear.J_l:g} kg·m², "
            f"K {gear.K:g} N·m/rad) at loop.rate {loop.rate:g} Hz and loop.speed_filter {loop.speed_filter:g} s; "
            "expected gains that let it come to rest: hdrig tune finds some"
        )


def swings_up(bench: Bench, procedure: Procedure) -> bool:
    """Whether it would; never where the host closes no loop with those gains."""
    loop = loop_of(bench, procedure)
    return loop is not None and loop.swings_up(bench.gains)


def loop_of(bench: Bench, procedure: Procedure) -> Loop | None:
    """What the bench's gains close the loop around; None where the drive closes it, or a locked gear is wound up with
    stiffer gains."""
    if bench.mode is not Mode.TORQUE or procedure.output_locked or not procedure.closes_loop:
        return None
    setting = bench.setting(lambda text: None)
    return Loop(setting.drivetrain, setting.period, bench.file.loop.speed_filter)


def margins(bench: Bench, procedure: Procedure) -> list[tuple[str, float, float, str, float]]:
    """(what, asked, limit, unit shown, SI → shown) of everything the procedure will ask for at most."""
    envelope, limits = procedure.envelope(bench.setting(lambda text: None)), bench.limits
    found = [
        ("travel", envelope.travel, limits.travel, "deg", 1 / DEG),
        ("speed", envelope.speed, limits.speed, "rpm", 1 / RPM),
        ("torque", envelope.torque, bench.gains.torque_limit, "N·m", 1.0),
    ]
    if limits.shaft_torque is not None and math.isfinite(envelope.shaft_torque):
        found.append(("shaft", envelope.shaft_torque, limits.shaft_torque, "N·m", 1.0))
    if envelope.loop:
        found.append(("loop", envelope.loop, PER_TICK * bench.file.loop.rate, "rad/s", 1.0))
    return found
