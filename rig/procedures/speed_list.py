"""Speeds as a person lists them."""

from __future__ import annotations

import math

from rig.core.errors import UsageError


def speeds_of(speeds_rpm: str) -> tuple[float, ...]:
    """rpm, in the order given, of "5,10,20". Raises UsageError when one is no speed."""
    try:
        speeds = tuple(float(word) for word in speeds_rpm.split(","))
    except ValueError:
        speeds = ()
    if not speeds or not all(0.0 < speed < math.inf for speed in speeds):
        raise UsageError(f"speeds_rpm = {speeds_rpm}: expected speeds above 0 rpm, divided by commas")
    return speeds
