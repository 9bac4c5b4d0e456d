"""What settles anew in every run: an amplifier that is switched on with it, a brake that lets go."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from functools import partial
from typing import Final

import numpy as np

from rig.analysis.tracing.residual.binned import Halves
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.joined import Rest
from rig.analysis.tracing.residual.lines import SENSES
from rig.analysis.tracing.residual.readings import in_columns, share
from rig.model.effect import Array

CONSTANTS: Final = (0.6, 1.5, 4.0, 8.0, 16.0, 40.0)  # s
MOMENTS: Final = np.arange(1.0, 20.0)  # s since the start: runs of constant speed are 10 to 20 s long
POWERS: Final = (2, 4)  # of the speed, with which a drag grows: of churned oil, and of what the speed itself lets loose
MOST: Final = 0.6  # of the excess: one number that foretells so much of it is no chance


def settled(h: Halves, channel: str) -> list[Home]:
    """One number that is gone exponentially with the time since each run began, or is there from one moment of each run
    on: the time constant, or the moment, that foretells most. Where runs begin at one angle, or a torque has acted
    since, those tell it as well, with many numbers: the one that does nearly as well with one is said first."""
    if not h.rest.timed:
        return []
    found = max((_within(h, channel, *law) for law in _laws(channel)), key=lambda home: home.share)
    return [found] if found.first else []


Law = tuple[Callable[[Rest], Array], str]
"""What it is of the time since each run began (n,), and in words."""


def _laws(channel: str) -> Iterator[Law]:
    """Of an angle's zero, or of a torque; of a torque as of friction as well, which turns with the way, and of the
    motor's as a drag: what pulls at the load the further it has turned is none, and would look like one."""
    for sense in SENSES if channel in "ML" else SENSES[:1]:
        for tau in CONSTANTS:
            yield partial(_falls, tau, sense), f"with a time constant near {tau:.2g} s"
        for moment in MOMENTS.tolist() if channel in "ML" else ():
            yield partial(_is_there, moment, sense), f"from about {moment:.2g} s on"
    for power, tau in itertools.product(POWERS if channel == "M" else (), CONSTANTS):
        yield partial(_sets_in, tau, power), f"as a drag that settles with a time constant near {tau:.2g} s"


def _falls(tau: float, sense: Callable[[Rest], Array], r: Rest) -> Array:
    return np.asarray(np.exp(-_since_it_began(r) / tau) * sense(r))


def _sets_in(tau: float, power: int, r: Rest) -> Array:
    speed = r.at["speed"] / max(float(np.abs(r.at["speed"]).max()), 1e-9)
    return np.asarray(-np.expm1(-_since_it_began(r) / tau) * np.abs(speed) ** power * np.sign(speed))


def _is_there(moment: float, sense: Callable[[Rest], Array], r: Rest) -> Array:
    return np.asarray((_since_it_began(r) > moment) * sense(r))


def _within(h: Halves, channel: str, law: Callable[[Rest], Array], words: str) -> Home:
    read = in_columns(lambda rest: law(rest)[:, None])
    found = share(h, read)
    return Home("time", channel, found, read=read, first=found > MOST, said=f"the time since each run began, {words}")


def _since_it_began(r: Rest) -> Array:
    """Time of each row since its run did, s (n,)."""
    time, began = r.at["time"], np.zeros(r.e.size)
    for run in np.unique(r.run):
        mine = r.run == run
        began[mine] = time[mine].min()
    return np.asarray(time - began)
