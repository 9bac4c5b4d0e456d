"""What a bench does not allow a procedure, told before anything moves."""

from __future__ import annotations

import math

from rig.bench import Bench
from rig.core.errors import NotReady, UsageError
from rig.core.operator import Rigging
from rig.core.procedure import Procedure
from rig.core.sample import Mode
from rig.core.units import DEG, RPM

TOLD = {"travel": "motor travel", "speed": "motor speed", "torque": "motor torque", "shaft": "shaft torque"}
LIMITS = {
    "travel": "limits.travel_turns",
    "speed": "limits.speed_rpm",
    "torque": "the smaller of limits.torque and motor.torque_limit",
    "shaft": "limits.shaft_torque, what the torque sensor may carry",
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
    try:
        envelope = procedure.envelope(bench.setting(lambda text: None))
        finite = all(abs(x) < LARGEST for x in (envelope.duration, envelope.travel, envelope.speed, envelope.torque))
    except (OverflowError, ZeroDivisionError):
        finite = False
    if not finite or not 0 < envelope.duration < LONGEST:
        raise UsageError(f"{procedure.title()} with these parameters is endless or immeasurably fast: check them")


def refuse_mode(bench: Bench, procedure: Procedure) -> None:
    """Raises NotReady when the drive is to close the loop itself, and the procedure has no reference to give it."""
    if bench.mode is not Mode.TORQUE and not procedure.has_reference:
        raise NotReady(
            f"{procedure.title()} asks for torques and has no reference throughout: the drive cannot be given "
            f'{bench.mode} setpoints; set control.mode = "torque"'
        )


def refuse_beyond_limits(bench: Bench, procedure: Procedure) -> None:
    """Raises NotReady when the procedure asks for more than the bench allows."""
    envelope = procedure.envelope(bench.setting(lambda text: None))
    reserved = ("shaft",) if procedure.output_locked else ("speed", "shaft")
    by_torque_first = sorted(margins(bench, procedure), key=lambda margin: margin[0] != "torque")  # what was given
    for what, asked, limit, unit, scale in by_torque_first:
        if asked > limit:
            wanted, allowed = f"{asked * scale:g} {unit}", f"{limit * scale:g} {unit}"
            why = f" ({envelope.reserve})" if envelope.reserve and what in reserved else ""
            raise NotReady(
                f"{procedure.title()} asks for up to {wanted} of {TOLD[what]}{why}, the bench allows {allowed}: "
                f"{LIMITS[what]}"
            )


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
    return found
