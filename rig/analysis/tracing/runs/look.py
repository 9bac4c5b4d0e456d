"""What of a run is looked at beyond what the first look takes in; one field a second look."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Look:
    """The first look has none of them."""

    reversals: bool = False  # the rows around a reversal too, in which friction has no sure sign
    held_load: bool = False  # of a locked one: its load angle by itself, not the wind-up
    gain: bool = False  # its motor torque beside a gain that all runs share: nobody knows a torque constant well
    late_motor: bool = False  # its motor torque beside a delay that all runs share
    steady: bool = False  # the mean of its motor torque is no run's own
    rigid: bool = False  # its wind-up is what is believed of the gear: nothing in these runs tells it
    inertia: bool = False  # its torque beside the inertia of the load, which nobody stated and no sensor weighs
    narrow: float = 0.0  # Hz, of a low-pass that is lower than usual: chosen when it is read
    fast: bool = False  # rows twice as often, compared up to frequencies twice as high: chosen when it is read
    late_torque: float = 0.0  # s, by how much its torque sensor is brought forward: chosen when it is read
    late_load: float = 0.0  # s, the same of its load angle
    zeros: float = 0.0  # rad its zero is off the others, but for what speed makes of it; 0: any, its own


FIRST = Look()
