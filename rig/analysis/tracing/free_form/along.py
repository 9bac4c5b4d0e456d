"""What a form may run along: the factors of a coordinate that fitted runs cover."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Final, NamedTuple

import numpy as np

from rig.analysis.tracing.free_form.factors import (
    Factor,
    began,
    hats,
    load_waves,
    motor_waves,
    past_torque,
    remembering,
    turned,
    turned_each_way,
)
from rig.analysis.tracing.free_form.ranges import Ranges
from rig.analysis.tracing.residual.products import times
from rig.model.effect import Array, Signals

HATS: Final = 8  # over a range, times what a form is finer; over a surface half of them each way
ALONE: Final = 20  # orders of an angle by itself, the same


class Along(NamedTuple):
    """A factor, what it runs along in words, whether it is a surface over two coordinates, and whether it is what the
    torque has been: a torque on the load is in that reading, and would be told by itself."""

    factor: Factor
    words: str
    surface: bool = False
    of_the_torque: bool = False


class Hatted(NamedTuple):
    """What hats are laid over, in words, and whether knots lie where rows do or as far apart as each other."""

    of: Callable[[Signals], Array]
    words: str
    crowded: bool

    def factor(self, seen: Ranges, count: int) -> Factor | None:
        """Hats of so many knots at most; None where all rows are alike, or nobody read it."""
        knots = (seen.crowded if self.crowded else seen.even)(self.of, count)
        return (lambda s: hats(self.of(s), knots)) if knots.size else None


HATTED: Final[Mapping[str, Hatted]] = {
    "load_angle": Hatted(lambda s: s.theta_l, "the output's angle", False),
    "speed": Hatted(lambda s: np.abs(s.omega_m), "the speed", True),
    "load": Hatted(lambda s: s.torque, "the torque", False),
    "time": Hatted(lambda s: s.t, "the time", False),
    "temperature": Hatted(lambda s: s.temperature, "the temperature", True),
}
BY_THE_CLOCK: Final = f"a curve along {HATTED['time'].words}"
"""A form's last words, where it runs along the campaign's own time."""
BY_THE_OUTPUT: Final = f"a curve along {HATTED['load_angle'].words}"
"""The same where it runs along the output's angle."""
OVER: Final = ("speed", "load", "time")
"""What a surface may be over, beside the coordinate."""


def along(coordinate: str, seen: Ranges, finer: int) -> Iterator[Along]:
    """Of that coordinate, `finer` times as fine as the coarsest; none of one that no form is drawn along."""
    match coordinate:
        case "motor_angle":
            yield Along(lambda s: motor_waves(s, 1, ALONE * finer), "waves of the motor's angle")
        case "load_angle":
            yield Along(lambda s: load_waves(s, ALONE * finer), "waves of the output's angle")
        case "time":
            yield Along(remembering(began, finer), "what wears off in the time since each run began")
        case "memory":
            back = "what wears off on the way since it turned back"
            yield Along(remembering(turned, finer, False), back)
            yield Along(remembering(turned, finer, True), f"{back} or began")
            yield Along(remembering(turned_each_way, finer), f"{back}, another each way")
            yield Along(remembering(past_torque), "what the torque has been", of_the_torque=True)
        case "direction":
            yield Along(lambda s: s.way[:, None], "the direction")
    if hatted := HATTED.get(coordinate):
        if factor := hatted.factor(seen, HATS * finer + 1):
            yield Along(factor, f"a curve along {hatted.words}")
        yield from _surfaces(coordinate, seen, HATS // 2 * finer + 1)


def _surfaces(coordinate: str, seen: Ranges, count: int) -> Iterator[Along]:
    """Over the coordinate and each of the others that runs differ in."""
    first = HATTED[coordinate].factor(seen, count)
    for name in OVER:
        second = HATTED[name].factor(seen, count)
        if name != coordinate and first and second:
            words = f"a surface over {HATTED[coordinate].words} and {HATTED[name].words}"
            yield Along(_product(first, second), words, surface=True)


def _product(first: Factor, second: Factor) -> Factor:
    return lambda s: times(first(s), second(s))
