"""What a procedure would do on a bench, in lines for a person. Writes nothing, moves nothing."""

from __future__ import annotations

from rig.bench import Bench
from rig.core.channels import CHANNELS
from rig.core.procedure import Procedure
from rig.refusals import margins


def plan_lines(bench: Bench, procedure: Procedure) -> list[str]:
    """What a dry run prints: travel, speed, torque, energy, duration, bytes, and the margins to every limit."""
    envelope = procedure.envelope(bench.setting(lambda text: None))
    rows = int(envelope.duration * bench.file.loop.rate)
    size = rows * 8 * len(CHANNELS) * 1.4 / 1e6  # journal as it is, archive at about 0.4 of it
    gear = bench.file.gear
    inertia = gear.J_m + gear.J_l / gear.N**2
    lines = [
        f"procedure   {procedure.title()} on {bench.file.name}{' (SIMULATED)' if bench.simulated else ''}",
        f"duration    at most {envelope.duration:.1f} s of rig time, {rows} rows, about {size:.0f} MB",
        f"energy      {0.5 * inertia * envelope.speed**2:.4f} J in motion, at the motor's speed",
    ]
    for what, asked, limit, unit, scale in margins(bench, procedure):
        if what == "torque":  # the loop is clamped there: what it will need is known only once it runs
            lines.append(f"{what:11s} at most {asked * scale:g} {unit} (clamped), limit {limit * scale:g} {unit}")
            continue
        lines.append(
            f"{what:11s} {asked * scale:g} of {limit * scale:g} {unit}, margin {100 * (1 - asked / limit):.0f} %"
        )
    return [*lines, *procedure.remarks(bench.setting(lambda text: None))]
