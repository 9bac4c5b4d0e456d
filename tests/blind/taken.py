"""A run as the loggers wrote it: what passes from plant to folders, and from folders to whoever analyses them."""

from __future__ import annotations

from dataclasses import dataclass

from tests.blind.plans import RunPlan
from tests.blind.sensors import Columns


@dataclass(frozen=True)
class Taken:
    """Conditions and columns of one run."""

    plan: RunPlan
    columns: Columns
