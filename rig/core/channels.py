"""The columns of a run: name, type, unit, meaning. One table that sample, ring, journal and archive follow."""

from __future__ import annotations

from enum import IntFlag
from typing import NamedTuple


class Channel(NamedTuple):
    """One column. `dtype` is "float64", "int64" or "uint32"; a bare name is SI."""

    name: str
    dtype: str
    unit: str
    meaning: str


class Flag(IntFlag):
    """Quality bits of one row (`flags`). Zero means nothing to report; they only ever add."""

    SIMULATED = 1 << 0  # the value came from the twin
    STALE_M = 1 << 1  # no new motor sample since the last row
    STALE_L = 1 << 2  # no new load-encoder sample since the last row
    STALE_TAU = 1 << 3  # no new torque-sensor sample since the last row
    FROZEN_M = 1 << 4  # device time advances, the value does not although the other side moves: honoured in
    FROZEN_L = 1 << 5  # runs made elsewhere; our loop trips on such an encoder instead (twist, following, load travel)
    FROZEN_TAU = 1 << 6  # the torque sensor gave the very same value for a second: a hint, coarse sensors do that
    SATURATED_TAU = 1 << 7  # torque sensor at the end of its range
    SATURATED_DRIVE = 1 << 8  # the drive could not give the torque asked for
    MISSED = 1 << 9  # one or more control cycles were skipped just before this row
    EPOCH = 1 << 10  # an encoder was re-referenced here: angles before and after do not join
    TRIPPED = 1 << 11  # at or after the sample the guard refused


UNTRUSTED = Flag.STALE_M | Flag.STALE_L | Flag.FROZEN_M | Flag.FROZEN_L | Flag.TRIPPED
"""Rows in which the two angles do not belong together, or the drive had let go."""

CHANNELS: tuple[Channel, ...] = (
    Channel("t", "float64", "s", "monotonic time since the run's start, when the motor angle was latched"),
    Channel("theta_m", "float64", "rad", "motor (wave generator) angle, unwrapped, positive as commanded"),
    Channel("theta_l", "float64", "rad", "load angle, unwrapped, positive when it follows the motor"),
    Channel(
        "omega_m", "float64", "rad/s", "motor speed, the host's filtered derivative of theta_m (filter in bench.toml)"
    ),
    Channel("tau_m", "float64", "N·m", "motor torque as the drive reports it, motor side, positive drives forward"),
    Channel(
        "tau_l", "float64", "N·m", "torque sensor between gear and load, positive when the gear drives the load forward"
    ),
    Channel("tau_ask", "float64", "N·m", "motor torque the procedure asked for"),
    Channel("tau_applied", "float64", "N·m", "motor torque the drive was really given"),
    Channel("theta_ref", "float64", "rad", "reference of the motor angle, where the procedure has one"),
    Channel("age", "float64", "s", "age of the oldest channel in this row when the row was made"),
    Channel("counts_m", "int64", "counts", "motor encoder, raw, unwrapped"),
    Channel("counts_l", "int64", "counts", "load encoder, raw, unwrapped"),
    Channel("flags", "uint32", "", "quality bits: " + ", ".join(f"{int(f)}={f.name}" for f in Flag)),
)

CHANNEL = {c.name: c for c in CHANNELS}
