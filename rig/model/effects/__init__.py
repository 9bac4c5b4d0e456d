"""The library of effects the paper's model lacks, one per file; a file bears the effect's name.

How to write one: subclass `Effect` (rig/model/effect/effect.py), `name` as the file, and say

- `shapes(reach)`: the few values of each nonlinear parameter that together leave no gap between them (neighbours should
  share about 90 % of what they explain; the refit finds the exact value). An order or frequency to be scanned is a
  shape too. Return () when such a campaign cannot show the effect (for example too few output turns).
- `columns(signals, shape)`: at the port where the effect acts, its physical law at every sample, (n, k), in SI, with
  the coefficient still to be found left out. The engine maps ports to the equations (which channel a thing shows in is
  what tells a bad sensor from a real torque), filters columns and readings alike, masks sticking and reversals and
  takes out every run's own offsets. A kinematic error that really is in the gear also gives LEVER, its derivative by
  theta_m. Use signals as given: do not filter again, do not take differences. States with memory start at rest.
- `parameters(fit)`: coefficients as the field names them, with unit and 95 % interval (`harmonic`, `parameter`); and
  `glosses`: what each of them is, in a short phrase with its symbol (`waved` for a pair of `harmonic`).
- `plausible(fit)`: signs that must hold (friction opposes motion).

Then add it to CATALOGUE. `tests/contract/test_effects.py` checks every member. Effects whose coefficients every run has
to itself (`each_run`) stand in EACH_RUN: they are looked for run by run, not in the search over shared coefficients;
one whose laws are of both kinds stands in both.
"""

from __future__ import annotations

from rig.model.effect import Effect
from rig.model.effects.angle_dependent_stiffness import AngleDependentStiffness
from rig.model.effects.channel_time_skew import ChannelTimeSkew
from rig.model.effects.cogging_torque import CoggingTorque
from rig.model.effects.encoder_interpolation_error import EncoderInterpolationError
from rig.model.effects.external_vibration import ExternalVibration
from rig.model.effects.flexspline_frame_error import FlexsplineFrameError
from rig.model.effects.gravity_unbalance import GravityUnbalance
from rig.model.effects.hysteretic_stiffness import HystereticStiffness
from rig.model.effects.load_dependent_friction import LoadDependentFriction
from rig.model.effects.load_dependent_kinematic_error import LoadDependentKinematicError
from rig.model.effects.lost_motion import LostMotion
from rig.model.effects.missed_counts import MissedCounts
from rig.model.effects.motor_encoder_eccentricity import MotorEncoderEccentricity
from rig.model.effects.nonlinear_stiffness import NonlinearStiffness
from rig.model.effects.output_once_per_rev import OutputOncePerRev
from rig.model.effects.position_dependent_friction import PositionDependentFriction
from rig.model.effects.presliding_friction import PreslidingFriction
from rig.model.effects.quadratic_drag import QuadraticDrag
from rig.model.effects.stribeck_friction import StribeckFriction
from rig.model.effects.support_compliance import SupportCompliance
from rig.model.effects.thermal_friction_drift import ThermalFrictionDrift
from rig.model.effects.tooth_mesh_error import ToothMeshError
from rig.model.effects.torque_ripple import TorqueRipple
from rig.model.effects.torque_sensor_crosstalk import TorqueSensorCrosstalk
from rig.model.effects.torsional_mode import TorsionalMode

CATALOGUE: dict[str, Effect] = {
    effect.name: effect
    for effect in (
        StribeckFriction(),
        PreslidingFriction(),
        LoadDependentFriction(),
        PositionDependentFriction(),
        ThermalFrictionDrift(),
        QuadraticDrag(),
        NonlinearStiffness(),
        HystereticStiffness(),
        AngleDependentStiffness(),
        LostMotion(),
        LoadDependentKinematicError(),
        OutputOncePerRev(),
        FlexsplineFrameError(),
        ToothMeshError(),
        GravityUnbalance(),
        CoggingTorque(),
        TorqueRipple(),
        MotorEncoderEccentricity(),
        EncoderInterpolationError(),
        ChannelTimeSkew(),
        TorqueSensorCrosstalk(),
        TorsionalMode(),
        SupportCompliance(),
        MissedCounts(),
    )
}

EACH_RUN: dict[str, Effect] = {effect.name: effect for effect in (ExternalVibration(), MissedCounts())}
LIBRARY: dict[str, Effect] = CATALOGUE | EACH_RUN
