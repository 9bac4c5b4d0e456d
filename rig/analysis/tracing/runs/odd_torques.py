"""A torque that one run reads otherwise than the others do: a sensor that hung, another unit, the other sign, or the
other torque.

Such a run makes repeats differ by more than any effect does: the floor is then what is wrong with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.tracing.runs.alike import alike, moved_alike
from rig.analysis.tracing.runs.recording import Recording

TORQUES: Final = {"tau_m": "τ_m", "tau_l": "τ_l"}
UNIT: Final = 20.0  # times what repeats read: friction that warms away halves, and the next unit is 100 or 1000
AS_LARGE: Final = 1.3  # times: as far as repeats of one condition differ in size, and two torques by more
SHARE: Final = 0.1  # of size times speed: less power has no sign
MOST: Final = 0.8  # of the runs that turn freely: the sign they agree in is right


@dataclass(frozen=True)
class Read:
    """One torque of one run: RMS and range [N·m], its first reading, and the mean of it times the motor's speed [W],
    which of what rubs is above zero."""

    run: Recording
    size: float
    spread: float
    first: float
    power: float
    speed: float  # rad/s, RMS

    @property
    def tells(self) -> bool:
        """Whether friction is enough of it to have a sign: under a weight, forth and back, the shaft shows little."""
        return abs(self.power) > SHARE * self.size * self.speed


def odd_torques(runs: Sequence[Recording]) -> dict[str, str]:
    """What is wrong with a torque beside that of the other runs of its kind, by the run's name; nothing where none
    tells."""
    wrong: dict[str, str] = {}
    for channel, words in TORQUES.items():
        for locked in (False, True):
            mine = [_read(r, channel) for r in runs if r.locked is locked and channel in r.has]
            mine = [one for one in mine if one.run.procedure != "standstill"]
            for one in mine:
                others = [other for other in mine if other is not one]
                if others and (said := _said(one, others)):
                    wrong.setdefault(one.run.name, said.format(words))
    return wrong | _exchanged([run for run in runs if TORQUES.keys() <= run.has and run.procedure != "standstill"])


def _exchanged(runs: Sequence[Recording]) -> dict[str, str]:
    """Runs that read in each torque what their repeats read in the other, further from what most runs do than these."""
    both = {run.name: np.log([_read(run, channel).size or np.nan for channel in TORQUES]) for run in runs}
    apart = {name: float(at_motor - at_load) for name, (at_motor, at_load) in both.items()}
    wrong: dict[str, str] = {}
    for run in runs:
        like = [both[other.name] for other in runs if other is not run and _moved(other, run)]
        usual = float(np.median([apart[other.name] for other in runs if other.locked is run.locked]))
        if not like or not all(np.abs(both[run.name] - x[::-1]).max() < np.log(AS_LARGE) for x in like):
            continue
        further = all(abs(apart[run.name] - usual) > abs(float(x[0] - x[1]) - usual) for x in like)
        if further and abs(apart[run.name]) > np.log(AS_LARGE**2):
            wrong[run.name] = "its τ_m is what its repeats read in τ_l, and its τ_l what they read in τ_m: exchanged"
    return wrong


def _moved(a: Recording, b: Recording) -> bool:
    """Whether both are of one condition by all that is no torque."""
    return a.locked is b.locked and moved_alike(a, b)


def _said(one: Read, others: Sequence[Read]) -> str | None:
    like = [other for other in others if _repeats(one.run, other.run)]
    return _stuck(one, others) or (_unit(one, like, others) or _sign(one, like, others) if like else None)


def _repeats(a: Recording, b: Recording) -> bool:
    """Whether both are of one condition; under one weight by what is said, for what is read may be the odd torque."""
    return moved_alike(a, b) if a.load_stated and b.load_stated else alike(a, b)


def _stuck(one: Read, others: Sequence[Read]) -> str | None:
    if one.spread > 0 or sum(other.spread > 0 for other in others) <= len(others) / 2:
        return None
    return (
        f"its {{}} is {one.first:.4g} N·m throughout, that of other runs moves: the sensor hung, or was not connected"
    )


def _unit(one: Read, like: Sequence[Read], others: Sequence[Read]) -> str | None:
    """Where all repeats read so much less or more, and are nearer to what all runs read."""
    sizes, usual = np.array([other.size for other in like]), float(np.median([other.size for other in others]))
    if min(one.size, usual, float(sizes.min())) <= 0:
        return None
    ratios = np.log(one.size / sizes)
    further = abs(np.log(one.size / usual)) > float(np.max(np.abs(np.log(sizes / usual))))
    if not further or not (ratios.min() > np.log(UNIT) or ratios.max() < -np.log(UNIT)):
        return None
    times = float(np.exp(np.median(ratios)))
    said = f"{times:.0f} times" if times > 1 else f"one {1 / times:.0f}th of"
    return f"its {{}} is {said} that of its repeats, as if in another unit"


def _sign(one: Read, like: Sequence[Read], others: Sequence[Read]) -> str | None:
    """Where it takes what its repeats and most other runs give, the motor against its friction."""
    against = float(np.mean([other.power * one.power < 0 for other in others]))
    if one.run.locked or against < MOST or not all(other.tells for other in (one, *like)):
        return None
    if not all(0.5 * abs(other.power) < abs(one.power) < 2.0 * abs(other.power) for other in like):
        return None
    if not all(one.power * other.power < 0 for other in like):
        return None
    return "its {} has the other sign than that of its repeats"


def _read(run: Recording, channel: str) -> Read:
    x = np.concatenate([getattr(piece, channel) for piece in run.pieces])
    omega = np.concatenate([piece.omega_m for piece in run.pieces])
    size = float(np.sqrt(np.nanmean(x**2)))
    speed = float(np.sqrt(np.mean(omega**2)))
    return Read(run, size, float(np.ptp(x)), float(x[0]), float(np.nanmean(x * omega)), speed)
