"""Which law without a name stands for what, and which look-alike of the library it takes the place of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Solution, design, extended, fit
from rig.analysis.tracing.fit.search import Scored, reduced
from rig.analysis.tracing.nameless.angles import OtherScale, WarmedMount
from rig.analysis.tracing.nameless.drags import OvalPulley, SectorDrag, SlowingDrag, UnevenDrag, WoundCable
from rig.analysis.tracing.nameless.errors import ErrorBySpeed, ErrorDrift, SharpError
from rig.analysis.tracing.nameless.frames import PulledAside
from rig.analysis.tracing.nameless.inertias import UnevenInertia
from rig.analysis.tracing.nameless.loops import CouplingPlay, Creep, DraggedSensor, SensorLoop
from rig.analysis.tracing.nameless.readings import (
    ConstantDrift,
    Droop,
    SensorCurve,
    SensorGainDrift,
    SensorJump,
    SensorRipple,
    SensorScale,
    SensorWaves,
    ThrownSensor,
    TwoConstants,
    TwoGains,
)
from rig.analysis.tracing.nameless.springs import EvenSpring, SpringBySpeed, SpringByWarmth, SpringDrift
from rig.analysis.tracing.nameless.wiped import WipedGrease
from rig.model.effect import Effect, Reach


@dataclass(frozen=True)
class Confounder:
    """A law without a name, and what is said where it stands."""

    effect: Effect
    coordinate: str  # it lives in
    sentence: str
    mimics: frozenset[str] = (
        frozenset()
    )  # effects of the library it is taken for, each of which it is tried in place of
    searched: bool = True  # for itself as well; not where a friction of the load would be taken for it
    zero_of: str = ""  # a channel whose zero is every run's own beside it
    short: float = 0.0  # share of what its look-alike explains that it may explain less


CONFOUNDERS: Final = {
    "creep": Confounder(
        Creep(),
        "memory",
        "A part of the wind-up follows the torque seconds late, as creep does; a loop that does not depend on the rate "
        "explains these runs no better by a twentieth, and no effect of the library explains it.",
        mimics=frozenset({"hysteretic_stiffness"}),
        short=0.05,  # its times are a few for all: six loops leave it 7 % short and more, a creep 2 %
    ),
    "coupling_play": Confounder(
        CouplingPlay(),
        "direction",
        "The load angle stays behind by the same whichever way the motor turns and whatever the torque, as an encoder "
        "does whose coupling has play; a loop in the spring explains less, and no effect of the library explains it.",
        mimics=frozenset({"hysteretic_stiffness", "lost_motion"}),
    ),
    "dragged_sensor": Confounder(
        DraggedSensor(),
        "direction",
        "The torque sensor reads more by the same whichever way the output turns, and nothing winds up by it, as one "
        "does whose own bearing drags. No effect of the library does so.",
    ),
    "sensor_loop": Confounder(
        SensorLoop(),
        "memory",
        "The torque that is read stays behind the torque there is by more the longer it has swung, as a sensor with "
        "hysteresis does; a loop in the spring explains less, and no effect of the library explains it.",
        mimics=frozenset({"hysteretic_stiffness"}),
        searched=False,
        zero_of="L",
    ),
    "sensor_waves": Confounder(
        SensorWaves(),
        "motor_angle",
        "The torque sensor reads waves of the motor's angle that no inertia of the load goes with, as gauges do that "
        "feel the wave generator; cogging of the motor explains less, and no effect of the library explains it.",
        mimics=frozenset({"cogging_torque"}),
        searched=False,
    ),
    "sensor_ripple": Confounder(
        SensorRipple(),
        "motor_angle",
        "The torque sensor reads waves of the motor's angle too much, of one height or in proportion to the torque, as "
        "gauges do that feel the wave generator. No effect of the library does so.",
    ),
    "even_spring": Confounder(
        EvenSpring(),
        "load",
        "The gear winds up less one way than the other, with the square of the torque; a stiffness that changes with "
        "the angle explains no more, and no effect of the library is so.",
        mimics=frozenset({"angle_dependent_stiffness"}),
    ),
    "spring_drift": Confounder(
        SpringDrift(),
        "time",
        "The stiffness changes through the campaign: the same torque winds the gear up by more or less in later runs. "
        "No effect of the library does so.",
    ),
    "spring_by_warmth": Confounder(
        SpringByWarmth(),
        "temperature",
        "The stiffness follows the temperature that was logged: the same torque winds the gear up by more or less when "
        "it is warmer. No effect of the library does so.",
    ),
    "error_drift": Confounder(
        ErrorDrift(),
        "time",
        "The kinematic error changes through the campaign: it grows or shrinks with the time that has passed. No "
        "effect of the library does so.",
    ),
    "sensor_gain_drift": Confounder(
        SensorGainDrift(),
        "time",
        "The torque sensor's gain changes through the campaign: the same torque reads more or less in later runs. No "
        "effect of the library does so.",
    ),
    "constant_drift": Confounder(
        ConstantDrift(),
        "time",
        "The motor's torque constant changes through the campaign: the same torque is told as more or less in later "
        "runs. No effect of the library does so.",
    ),
    "sensor_jump": Confounder(
        SensorJump(),
        "load",
        "The torque sensor jumps where the torque turns round, and no load and no motor goes with it; a gap in the "
        "gear explains less, and no effect of the library explains it.",
        mimics=frozenset({"nonlinear_stiffness", "lost_motion"}),
    ),
    "sensor_curve": Confounder(
        SensorCurve(),
        "load",
        "The torque sensor is not linear: under load it reads too much or too little, and neither motor nor load goes "
        "with it; a spring that is not linear explains less, and no effect of the library explains it.",
        mimics=frozenset({"nonlinear_stiffness"}),
        searched=False,
    ),
    "thrown_sensor": Confounder(
        ThrownSensor(),
        "speed",
        "The torque sensor reads more or less the faster it turns, whichever way, as gauges do that are thrown "
        "outward. No effect of the library does so.",
    ),
    "sensor_scale": Confounder(
        SensorScale(),
        "load",
        "The torque sensor reads another torque than the weights that were declared make and the motor holds, in "
        "proportion to it: its scale, or theirs, is off. No effect of the library does so.",
    ),
    "two_gains": Confounder(
        TwoGains(),
        "load",
        "The torque sensor reads torque of one sign by more than of the other. No effect of the library does so.",
        mimics=frozenset({"angle_dependent_stiffness"}),
    ),
    "two_constants": Confounder(
        TwoConstants(),
        "direction",
        "The motor needs more current for the same torque one way than the other. No effect of the library does so.",
    ),
    "uneven_drag": Confounder(
        UnevenDrag(),
        "direction",
        "The motor is dragged by more at speed one way than the other. No effect of the library does so.",
    ),
    "error_by_speed": Confounder(
        ErrorBySpeed(),
        "speed",
        "The kinematic error changes with the speed of the motor, by more than flexibility makes of it. No effect of "
        "the library does so.",
    ),
    "sharp_error": Confounder(
        SharpError(),
        "motor_angle",
        "The kinematic error is sharper than fifteen orders, as over a dent in a race, and under load the motor has "
        "its lever to bear; ripple of the motor explains less, and no effect of the library explains it.",
        mimics=frozenset({"torque_ripple"}),
        searched=False,
    ),
    "spring_by_speed": Confounder(
        SpringBySpeed(),
        "speed",
        "The same torque winds the gear up by more or less at speed. No effect of the library does so.",
    ),
    "slowing_drag": Confounder(
        SlowingDrag(),
        "speed",
        "A drag grows with less than the speed, as of a grease that thins where it is sheared. No effect of the "
        "library does so.",
    ),
    "wiped_grease": Confounder(
        WipedGrease(),
        "memory",
        "The motor's friction is more where it has just turned back or set out, and wears off on the way, as of grease "
        "that is pushed away. No effect of the library does so.",
    ),
    "sector_drag": Confounder(
        SectorDrag(),
        "load_angle",
        "Friction of the load changes along the output's turn, and turns with the way. No effect of the library does "
        "so.",
    ),
    "oval_pulley": Confounder(
        OvalPulley(),
        "load_angle",
        "The external torque changes along the output's turn, in proportion to itself. No effect of the library does "
        "so.",
    ),
    "wound_cable": Confounder(
        WoundCable(),
        "load_angle",
        "The load is pulled back the further the output has turned, as by a loom of cables that is wound about it. No "
        "effect of the library does so.",
    ),
    "uneven_inertia": Confounder(
        UnevenInertia(),
        "load_angle",
        "The inertia on the output changes along its turn. No effect of the library does so.",
    ),
    "pulled_aside": Confounder(
        PulledAside(),
        "load",
        "The load angle is shifted by the weights that hang on the output, in proportion to them, and by no other "
        "torque, as where a weight pulls the shaft aside. No effect of the library does so.",
    ),
    "other_scale": Confounder(
        OtherScale(),
        "load_angle",
        "The load angle runs away from the motor's by the same with every turn, at any speed, and comes back: one of "
        "them is counted to another scale, or the ratio is another than was stated. No effect of the library does so.",
        mimics=frozenset({"missed_counts"}),
    ),
    "warmed_mount": Confounder(
        WarmedMount(),
        "temperature",
        "The load angle creeps away while the motor's friction makes heat and comes back as that leaks, as where what "
        "holds its encoder twists as it warms; lost counts explain less, and no effect of the library does so.",
        mimics=frozenset({"missed_counts"}),
    ),
    "droop": Confounder(
        Droop(),
        "load",
        "The motor's torque falls short of what is told, by more than in proportion, forth and back alike: its torque "
        "constant may droop. No effect of the library explains it.",
        mimics=frozenset({"load_dependent_friction"}),
    ),
}


def with_confounders(s: Solution, runs: Sequence[int], covered: Reach) -> Solution:
    """With the confounder in the place of its look-alike, or of another one that is there instead, wherever it explains
    more of the fitted runs, or as much with fewer coefficients; and the zero of its channel every run's own, where it
    leaves that to it."""
    n = sum(s.design.y[key].size / s.design.eq.noise.kappa[key[1]] for key in s.keys)
    instead: dict[str, frozenset[str]] = {}
    for name, confounder in CONFOUNDERS.items():
        alike = confounder.mimics | {other for other, of in instead.items() if of & confounder.mimics}
        mine = [i for i, term in enumerate(s.design.terms) if term.name in alike]
        shapes = confounder.effect.shapes(covered) if confounder.effect.needs <= covered.has else ()
        if mine and shapes:
            bare = reduced(s.design, mine)
            tried = [fit(extended(bare, Term(confounder.effect, shape), runs)) for shape in shapes]
            other = max(tried, key=lambda one: one.gain - one.design.size * np.log(n))
            saved = (s.design.size - other.design.size) * np.log(n)
            if confounder.short:
                saved += confounder.short * (s.gain - fit(bare).gain)
            mine_own, its_own = (_with_own_zeros(m, runs, confounder.zero_of) for m in (s, other))
            if its_own.gain - mine_own.gain + saved > 0.0:
                s, instead = its_own, instead | {name: confounder.mimics}
    return s


def _with_own_zeros(s: Solution, runs: Sequence[int], channel: str) -> Solution:
    """A model with the zero of that channel every run's own; as it is where none is said."""
    if not channel:
        return s
    eq = replace(s.design.eq, noise=s.design.eq.noise.free(channel))
    return fit(design(eq, s.design.terms, runs))


def of_the_library(ranking: Sequence[Scored]) -> tuple[Scored, ...]:
    """A ranking without confounders."""
    return tuple(r for r in ranking if r.term.name not in CONFOUNDERS)


def confounders_in(s: Solution) -> list[Confounder]:
    """The confounders in a model."""
    return [CONFOUNDERS[term.name] for term in s.design.terms if term.name in CONFOUNDERS]
