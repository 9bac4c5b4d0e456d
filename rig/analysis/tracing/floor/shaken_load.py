"""A line beside the motion that stands in the load's balance alone: something shakes the load, or a pick-up does its
reading. A torque that is only read winds nothing up, so that the wind-up misses it; one that is there does not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.interference import Interference
from rig.analysis.tracing.floor.local import clock
from rig.core.quantiles import Z95
from rig.model.effect import Array, Parameter, parameter
from rig.model.linear import held_frequency

MISSED: Final = 0.3  # of what the wind-up misses by a pick-up of either sensor, at most
FEWEST: Final = 3  # runs


@dataclass(frozen=True)
class ShakenLoad:
    """Usual frequency [Hz] and torque on the load [N·m], each with the half width of its 95 % interval."""

    frequency: tuple[float, float]
    torque: tuple[float, float]

    def parameters(self) -> tuple[Parameter, ...]:
        """As of a steady vibration."""
        return (
            parameter("frequency", *self.frequency, "Hz"),
            parameter("torque_amplitude", *self.torque, "N·m"),
        )

    def sentence(self) -> str:
        """That it is no steady line, and why no sensor's."""
        return (
            "The vibration wanders in strength, phase or frequency, so that it is read anew every few seconds; the "
            "wind-up shows none of it that the torque sensor does not, so that no pick-up of a sensor makes it."
        )


def shaken_load(s: Solution, line: Interference) -> ShakenLoad | None:
    """What makes the `line` in the residuals of `s`; None of one that is loudest in another channel, or that the
    wind-up may miss as it would a pick-up in the torque sensor, or in the load encoder."""
    eq = s.design.eq
    keys = [key for key in line.columns if key[1] == "L" and key in s.keys and (key[0], "A") in s.keys]
    keys = [key for key in keys if not eq.runs[key[0]].locked and "tau_l" in eq.runs[key[0]].knows]
    if line.channel != "L" or len(keys) < FEWEST or s.value("compliance") <= 0:
        return None
    missed = np.array([_missed(s, key, line.columns[key][:, 0]) for key in keys])
    half = Z95 * float(missed.std(ddof=1)) / np.sqrt(missed.size)
    gear = eq.runs[keys[0][0]].pieces[0].gear
    of_the_encoder = (held_frequency(gear.K, gear.J_l) / (2 * np.pi * line.frequency_hz)) ** 2
    if abs(missed.mean()) + half > MISSED * min(1.0, of_the_encoder):
        return None
    passed = np.exp(-0.5 * (line.frequency_hz / eq.runs[keys[0][0]].smoother.sigma_hz) ** 2)
    sizes = np.array([np.sqrt(2) * np.std(line.columns[key]) for key in keys]) / passed
    spread = Z95 * float(sizes.std(ddof=1)) / np.sqrt(sizes.size)
    half_hz = Z95 * max(line.apart - 1.0, 1e-3) * line.frequency_hz / np.sqrt(sizes.size)
    return ShakenLoad((line.frequency_hz, half_hz), (float(np.median(sizes)), spread))


def _missed(s: Solution, key: Key, wave: Array) -> float:
    """What the wind-up misses of the `wave` (n,) in the load's balance of a run, over what a pick-up in the torque
    sensor makes it miss: 1 of such a one, 0 of a torque that is there."""
    eq, angle = s.design.eq, (key[0], "A")
    there = np.interp(clock(eq, angle), clock(eq, key), wave)
    along = float(s.residual(angle) @ there) / max(float(there @ there), 1e-300)
    return -along / s.value("compliance")
