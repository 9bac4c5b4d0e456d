"""A change by hand within a session: what has to be known before anybody touches the rig, and be seen after."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rig.changes import (
    band_at_rest,
    judge_free,
    judge_lock,
    judge_weight,
    refuse_driving,
    refuse_unfit,
)
from rig.core.operator import Change, FreeOutput, HangWeight, LockOutput, Reassemble
from rig.procedures.lock_check import LockCheck
from rig.procedures.unwind import Unwind
from rig.procedures.weigh import Weigh

if TYPE_CHECKING:
    from rig.session.session import Session

LET_OUT = 3.0  # N·m wound up in a locked gear: more is let out before anybody pulls the pin


def prepare(session: Session, change: Change) -> None:
    """Whatever has to be known or undone before anybody touches the rig. Raises NotReady when it does not fit."""
    refuse_unfit(change, session.rigging, session.bench.limits.shaft_torque)
    match change:
        case HangWeight(tau_ext) if tau_ext:
            refuse_driving(tau_ext, session.bench.file.gear.N, session.tared().drag)
        case LockOutput() if session.proof is None:
            session.prove()
        case FreeOutput() if abs(_wound_up(session)) > LET_OUT:
            session.finding(Unwind())


def show(session: Session, change: Change) -> str:
    """What the sensors say of a change. Raises NotReady when it is not what was asked for."""
    match change:
        case HangWeight(tau_ext):
            if session.zero is None:  # taken off before it was known what nothing weighs
                return session.tare()
            zero, band = session.zero.torque, band_at_rest(tau_ext, session.zero.friction)
            return judge_weight(session.finding(Weigh(tau_ext, zero, band)), tau_ext, zero)
        case LockOutput():
            check = LockCheck()
            return judge_lock(session.finding(check), math.radians(check.angle_deg))
        case Reassemble() if (
            session.instruments.torque_sensor is not None
        ):  # what was taken apart has a zero of its own
            return f"{session.prove().sentence}; {session.tare()}"
        case FreeOutput():  # gently: a pin that is still in would let a whole turn wind the gear up
            return f"{judge_free(session.finding(LockCheck()))}; {session.prove().sentence}"
        case _:  # turns, and the output follows by the ratio
            return session.prove().sentence


def _wound_up(session: Session) -> float:
    """N·m at the torque sensor, at rest; 0 without a sensor."""
    session.come_to_rest()
    tau = session.instruments.look().tau_l
    return 0.0 if math.isnan(tau) else tau
