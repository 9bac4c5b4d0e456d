"""From a run to its Result: which analysis reads which procedure."""

from __future__ import annotations

import traceback
import warnings
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from rig.analysis.findings.collected import Findings, conclude
from rig.analysis.findings.result import Result
from rig.analysis.motion.held import not_held, not_still
from rig.analysis.motion.overview import add_overview
from rig.analysis.motion.source import Motion, Source, motion_of
from rig.analysis.motion.speed import Speed, motor_speed
from rig.analysis.motion.tame import Tame
from rig.analysis.sensors.latch_skew_words import LABEL as SKEW
from rig.analysis.sensors.latch_skew_words import add_latch_skew
from rig.analysis.sensors.seldom import said_seldom
from rig.analysis.turning.run import add_turning
from rig.core.drivetrain import RATIOS
from rig.core.kinds import Regime, regime_of
from rig.core.units import TURN
from rig.runfile.promised import rows_gone, time_untold

OF_DATA = (ArithmeticError, LookupError, MemoryError, RecursionError, ValueError)
"""What arithmetic on a damaged run can raise; a run must end in a sentence, whatever it holds."""
DEFECTS = (AssertionError, AttributeError, NameError, TypeError)
"""What only a mistake of ours raises, for what a run holds is looked at before: said so, with the traceback."""

WHOLE = 2.0  # turns of the motor, forth and back: less holds no whole one once the reversals are cut

Part = Callable[[Findings, Source, Motion, Speed | None], None]
"""Imports what it analyses with when it is asked: a run is of one procedure, and a person waits."""


def _slow(found: Findings, run: Source, motion: Motion, speed: Speed | None) -> None:
    add_turning(found, run, motion, speed, slow=True)


def _at_speed(found: Findings, run: Source, motion: Motion, speed: Speed | None) -> None:
    add_turning(found, run, motion, speed, slow=False)


def _constant_torque(found: Findings, run: Source, motion: Motion, speed: Speed | None) -> None:
    from rig.analysis.turning.constant_torque import add_constant_torque

    add_constant_torque(found, run, motion)


def _full_turn(found: Findings, run: Source, motion: Motion, speed: Speed | None) -> None:
    from rig.analysis.turning.full_turn import add_full_turn

    add_turning(found, run, motion, speed, slow=True)
    if not found.rejected:
        add_full_turn(found, run, motion)


def _coast_down(found: Findings, run: Source, motion: Motion, speed: Speed | None) -> None:
    from rig.analysis.friction.coast_down import add_coast_down

    add_coast_down(found, run, motion)


def _speed_convergence(found: Findings, run: Source, motion: Motion, speed: Speed | None) -> None:
    from rig.analysis.at_speed.convergence import add_speed_convergence

    add_speed_convergence(found, run, motion)


def _standstill(found: Findings, run: Source, motion: Motion, speed: Speed | None) -> None:
    from rig.analysis.sensors.standstill import add_standstill

    add_standstill(found, run, motion)


def _lock(found: Findings, run: Source, motion: Motion, reference: Source | None) -> None:
    from rig.analysis.stiffness import add_stiffness

    if not_held(motion.theta_l):
        return  # `_broken` says so, and a wind-up there is none
    add_stiffness(found, run, motion, reference)


def _split(found: Findings, run: Source, motion: Motion, reference: Source | None) -> None:
    from rig.analysis.at_speed.decomposition_words import add_decomposition

    add_decomposition(found, run, motion, reference)


def _other(found: Findings, run: Source, motion: Motion, speed: Speed | None) -> None:
    """A procedure with no analysis of its own: what it found itself as it ran, else what its motion allows."""
    turns = float(np.ptp(motion.theta_m)) / TURN
    if (said := str(run.manifest.get("finding") or "")) and turns < WHOLE:
        found.sentence = said
        found.exact("motor_travel", "Travel of the motor", turns, "turns", "Highest less lowest angle of the motor.")
        found.cannot.append("It is a check: what it found it said itself, when it ran, and nothing is computed again.")
        return
    found.cannot.append(
        f"There is no analysis for {run.manifest.get('label') or run.procedure} by itself: these figures are what any "
        "run of this motion gives."
    )
    if turns >= 1.0:
        _at_speed(found, run, motion, speed)
    elif run.conditions.get("output_locked"):
        _lock(found, run, motion, None)
    elif turns < 0.01:
        _standstill(found, run, motion, speed)
    else:
        from rig.analysis.kinematic_error.ratio import turns_per_turn
        from rig.analysis.motion.mistaken import mistaken

        why = mistaken(motion.ratio, turns_per_turn(motion)) or "nothing here is periodic in its angle"
        found.sentence = f"The motor moved {360 * turns:.2f}°, less than a turn: {why}."


def _friction(found: Findings, run: Source, motion: Motion, speed: Speed | None) -> None:
    from rig.analysis.friction.run import add_friction

    add_friction(found, run, motion)


PROCEDURES: Mapping[str, Part] = {
    "kinematic_error": _slow,
    "speed_convergence": _speed_convergence,
    "full_turn": _full_turn,
    "load_sweep": _slow,
    "assembly_sweep": _slow,
    "constant_torque": _constant_torque,
    "constant_speed": _at_speed,
    "sentinel": _constant_torque,
    "coast_down": _coast_down,
    "standstill": _standstill,
    "friction": _friction,
}


def analyse(run: Source, reference: Source | None = None, doubt: str = "", beyond: str = "") -> Result:
    """All that `run` says: figures with 95 % intervals, checks, curves, and what it cannot tell.

    `reference` is a slow run of the same gear: a run at speed is then split into the pure kinematic error and what
    flexibility makes of it; from the wind-up of a lock test the kinematic error is taken off.

    `doubt` says why the samples may not be those that were recorded, as what the manifest promises of them and they
    do not keep does: no limit is then met or missed. `beyond` says the same of torques larger than the rig's.

    `run` is a `rig.runfile.Run`, or anything with the same columns and manifest. Never raises on what a run lacks or
    holds, but HdrigError when its samples cannot be read: the Result says it. Limits and verdict: see
    `rig.analysis.findings.collected.conclude`.
    """
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")  # numpy's remarks on empty and constant pieces say nothing to an operator
        tame = Tame(run)
        try:
            return _analyse(tame, reference, doubt, beyond)
        except OF_DATA as why:
            said = f"The analysis broke off on what this run holds ({type(why).__name__}: {why})."
            return replace(_nothing(tame, said), broke_off=traceback.format_exc())
        except DEFECTS as why:
            said = f"The analysis broke off on a defect of hdrig, please report it ({type(why).__name__}: {why})."
            return replace(_nothing(tame, said), broke_off=traceback.format_exc(), defect=True)


def _nothing(run: Tame, why: str) -> Result:
    """A Result without figures."""
    found = Findings(sentence=why, inconclusive=why, cannot=[why, *run.notes])
    return conclude(found, run.procedure, {**run.manifest, "limits": {}})


def _broken(run: Tame, doubt: str) -> str:
    """Why the samples are not those that were recorded, "" when they are."""
    some = next((c for name in ("t", "theta_m", "theta_l") if (c := run.column(name)) is not None), None)
    gone = "" if some is None else rows_gone(run.manifest, some.size)
    if gone:
        gone = f"{gone}, so the figures are from a part of it"
    locked = regime_of(run.procedure) is Regime.LOCKED or bool(run.conditions.get("output_locked"))
    turned = not_held(run.column("theta_l")) if locked else ""
    moved = not_still(run.column("theta_m")) if run.procedure == "standstill" else ""
    found = [said for said in (doubt, gone, time_untold(run.manifest, run.column("t")), turned, moved) if said]
    return f"The samples are not what the manifest says: {'; '.join(found)}." if found else ""


def _analyse(run: Tame, reference: Source | None, doubt: str, beyond: str) -> Result:
    if not RATIOS[0] <= run.ratio <= RATIOS[1]:
        return _nothing(run, f"The manifest says a gear ratio of {run.ratio:g}: no gear has it, nothing was computed.")
    found = Findings(broken=_broken(run, doubt), beyond=beyond)
    motion = motion_of(run)
    if motion is None or motion.theta_m.size < 16:
        why = "No row of the run has a motor angle (theta_m): nothing can be said about the gear."
        if run.manifest.get("rows") == 0:
            why = "The run has no rows, it ended before its first sample: nothing can be said about the gear."
        elif motion is not None:
            rows = f"{motion.theta_m.size} usable row{'s' * (motion.theta_m.size != 1)}"
            why = f"The run has {rows}: nothing can be said about the gear."
        return _nothing(run, why)
    turns = float(np.ptp(motion.theta_m)) / TURN
    if turns > motion.theta_m.size:
        return _nothing(
            run, f"The motor angle moves {turns:.4g} turns in {motion.theta_m.size} rows: not an angle in rad."
        )
    found.cannot += motion.notes
    speed = None if motion.t is None else motor_speed(motion.t, motion.theta_m)
    add_overview(found, run, motion, speed)
    if regime_of(run.procedure) is Regime.LOCKED:
        _lock(found, run, motion, reference)
    elif run.manifest.get("label") == SKEW:
        add_latch_skew(found, run, motion)
    else:
        PROCEDURES.get(run.procedure, _other)(found, run, motion, speed)
    if regime_of(run.procedure) is Regime.AT_SPEED and not found.rejected:
        _split(found, run, motion, reference)
    found.cannot += [*([seldom] if (seldom := said_seldom(run, motion)) else []), *run.notes]
    return conclude(found, run.procedure, run.manifest)
