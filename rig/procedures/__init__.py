"""The catalogue of experiments: name on the command line → "module:class". One experiment per file."""

from __future__ import annotations

import importlib
from typing import cast

from rig.core.procedure import Procedure

CATALOGUE: dict[str, str] = {
    "kinematic-error": "rig.procedures.kinematic_error:KinematicError",
    "sign-and-scale": "rig.procedures.sign_and_scale:SignAndScale",
    "skew": "rig.procedures.skew:Skew",
    "step-test": "rig.procedures.step_test:StepTest",
    "weigh": "rig.procedures.weigh:Weigh",
    "lock-check": "rig.procedures.lock_check:LockCheck",
    "unwind": "rig.procedures.unwind:Unwind",
    "constant-torque": "rig.procedures.constant_torque:ConstantTorque",
    "full-turn": "rig.procedures.full_turn:FullTurn",
    "speed-convergence": "rig.procedures.speed_convergence:SpeedConvergence",
    "friction": "rig.procedures.friction:Friction",
    "coast-down": "rig.procedures.coast_down:CoastDown",
    "sentinel": "rig.procedures.sentinel:Sentinel",
    "standstill": "rig.procedures.standstill:Standstill",
    "held-standstill": "rig.procedures.held_standstill:HeldStandstill",
    "stiffness-lock": "rig.procedures.stiffness_lock:StiffnessLock",
    "compensated": "rig.procedures.compensated:Compensated",
    "jog": "rig.procedures.jog:Jog",
}


def procedure_class(name: str) -> type[Procedure]:
    """The experiment called `name` on the command line. KeyError when there is none."""
    module, _, member = CATALOGUE[name].partition(":")
    return cast(type[Procedure], getattr(importlib.import_module(module), member))
