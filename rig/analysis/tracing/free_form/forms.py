"""All that may act along a coordinate: at each port what changes with it, by itself or times what acts there anyway."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Final, NamedTuple

import numpy as np

from rig.analysis.tracing.fit.channels import ORDERS
from rig.analysis.tracing.free_form.along import ALONE, Along, along
from rig.analysis.tracing.free_form.factors import known, load_waves, motor_waves, remembering
from rig.analysis.tracing.free_form.form import FreeForm
from rig.analysis.tracing.free_form.ranges import Ranges
from rig.analysis.tracing.nameless.loops import way_of_the_output
from rig.analysis.tracing.residual.products import times
from rig.model.effect import Array, Port, Signals

PRODUCT: Final = 6  # orders of an angle times a factor, times what a form is finer
MOTOR: Final = frozenset({"tau_m"})
ANGLES: Final = frozenset({"theta_m", "theta_l"})
SENSOR: Final = frozenset({"tau_l"})  # without it the torque is made of what it would change


class At(NamedTuple):
    """A port, what is there in words, what a factor is multiplied by there (n,), and the channels that takes."""

    port: Port
    words: str
    by: Callable[[Signals], Array]
    wants: frozenset[str]

    def times(self, x: Array, s: Signals) -> dict[Port, Array]:
        """Columns (n, k) there."""
        return {self.port: x * known(self.by(s))[:, None]}


def _one(s: Signals) -> Array:
    return np.ones(s.t.size)


def _way(s: Signals) -> Array:
    return s.way


def _torque(s: Signals) -> Array:
    return s.torque


READING: Final = "the reading of the torque sensor"
FRICTION: Final = At(Port.LOAD_TORQUE, "friction of the load", _way, SENSOR)
ANGLE: Final = At(Port.READS_THETA_L, "the reading of the angles", _one, ANGLES)
PUSHED: Final = At(Port.MOTOR_TORQUE, "a torque on the motor", _one, MOTOR)
GAUGES: Final = At(Port.READS_TAU_L, READING, _one, ANGLES | SENSOR)
PLACES: Final = (
    At(Port.MOTOR_TORQUE, "friction of the motor", _way, MOTOR),
    PUSHED,
    At(
        Port.MOTOR_TORQUE, "friction of the motor, times the torque", lambda s: s.way * np.abs(s.torque), MOTOR | SENSOR
    ),
    At(Port.MOTOR_TORQUE, "a drag of the motor", lambda s: s.omega_m, MOTOR),
    At(Port.MOTOR_TORQUE, "an inertia of the motor", lambda s: s.alpha_m, MOTOR),
    FRICTION,
    At(Port.LOAD_TORQUE, "a torque on the load", _one, SENSOR),
    At(Port.LOAD_TORQUE, "a drag of the load", lambda s: s.omega_l, SENSOR),
    At(Port.LOAD_TORQUE, "a torque on the load, times what hangs there", lambda s: s.tau_ext, SENSOR),
    At(Port.LOAD_TORQUE, "an inertia of the load", lambda s: s.alpha_l, SENSOR),
    ANGLE,
    At(Port.READS_THETA_L, "the reading of the angles, by the direction", _way, ANGLES),
    At(Port.READS_THETA_L, "the reading of the angles, times their speed", lambda s: s.omega_l, ANGLES),
    At(Port.WIND_UP, "the wind-up, times the torque", _torque, ANGLES | SENSOR),
    At(Port.WIND_UP, "the wind-up, times the torque's rate", lambda s: s.torque_rate, ANGLES | SENSOR),
    GAUGES,
    At(Port.READS_TAU_L, f"{READING}, by the direction", _way, ANGLES | SENSOR),
    At(
        Port.READS_TAU_L,
        f"{READING}, by the direction of the output",
        lambda s: remembering(way_of_the_output)(s)[:, 0],
        ANGLES | SENSOR,
    ),
    At(Port.READS_TAU_L, f"{READING}, times the torque", _torque, ANGLES | SENSOR),
    At(Port.READS_TAU_M, "the motor's torque as told, times itself", lambda s: s.tau_m, MOTOR | SENSOR),
)


def forms(coordinate: str, seen: Ranges, finer: int) -> list[FreeForm]:
    """Of that coordinate, `finer` times as fine as the coarsest; none of one that no form is drawn along."""
    made = [*_angles(coordinate, finer)]
    for way in along(coordinate, seen, finer):
        made += [_form(at, way) for at in PLACES if not _by_itself(at, way)]
        if not way.surface and coordinate != "load_angle":
            waved = (FRICTION, ANGLE)
            made += [_waves_of_the_output(at, way, PRODUCT * finer) for at in waved if not _by_itself(at, way)]
        if not way.surface and coordinate not in ("motor_angle", "load_angle"):
            made += _waves_of_the_motor(way, PRODUCT * finer)
    return made


def _by_itself(at: At, way: Along) -> bool:
    """Whether what acts there would be told by its own reading."""
    return way.of_the_torque and at.port is Port.LOAD_TORQUE


def _form(at: At, way: Along) -> FreeForm:
    """The factor there."""
    return FreeForm(f"{at.words}: {way.words}", lambda s: at.times(way.factor(s), s), at.wants, way.surface)


def _waves_of_the_motor(way: Along, last: int) -> list[FreeForm]:
    """Waves of the motor's angle that are others along the coordinate."""

    def error(s: Signals) -> Mapping[Port, Array]:
        by = way.factor(s)
        values, slopes = (times(motor_waves(s, 1, last, slopes=which), by) for which in (False, True))
        return {Port.KINEMATIC_ERROR: values, Port.LEVER: slopes}

    def there(at: At) -> FreeForm:
        words = f"{at.words}: waves of the motor's angle, others with {way.words}"
        return FreeForm(words, lambda s: at.times(times(motor_waves(s, 1, last), way.factor(s)), s), at.wants)

    whole = FreeForm(f"the kinematic error, another with {way.words}", error, ANGLES)
    return [whole, there(PUSHED), there(GAUGES)]


def _waves_of_the_output(at: At, way: Along, last: int) -> FreeForm:
    """Waves of the output's angle that are others along the coordinate."""
    words = f"{at.words}: waves of the output's angle, others with {way.words}"
    return FreeForm(words, lambda s: at.times(times(load_waves(s, last), way.factor(s)), s), at.wants)


def _turned_round(last: int) -> FreeForm:
    """What an angle that is read wrong, or an inertia that changes with it, is in the torque."""
    words = f"{PUSHED.words}: waves of the motor's angle, as large as the square of its speed"
    return FreeForm(
        words, lambda s: PUSHED.times(times(motor_waves(s, 1, last), np.square(s.omega_m)[:, None]), s), wants=MOTOR
    )


def _angles(coordinate: str, finer: int) -> Iterator[FreeForm]:
    """What only an angle has: a kinematic error of more orders, and one that changes along the output's turn."""
    if coordinate == "motor_angle":
        first, last = ORDERS + 1, ORDERS + ALONE * finer

        def sharp(s: Signals) -> Mapping[Port, Array]:
            values, slopes = (motor_waves(s, first, last, slopes=which) for which in (False, True))
            return {Port.KINEMATIC_ERROR: values, Port.LEVER: slopes}

        yield FreeForm(f"the kinematic error, orders beyond {ORDERS}", sharp, wants=ANGLES)
        yield _turned_round(PRODUCT * finer)
    if coordinate in ("motor_angle", "load_angle"):
        turn = Along(lambda s: load_waves(s, 2 * finer), "the output's angle")
        yield from _waves_of_the_motor(turn, PRODUCT * finer)
