"""From the stiffness of the whole path to that of the gear: compliances in series add."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rig.analysis.motion.declared import declared

SERIES = {"K_sensor": "torque sensor", "K_coupling": "couplings", "K_fixture": "fixture"}


@dataclass(frozen=True)
class Path:
    """What lies in series with the gear between the motor encoder and the load encoder."""

    stiffnesses: tuple[tuple[str, float], ...]  # (what, N·m/rad)

    @property
    def compliance(self) -> float:
        """rad/(N·m)"""
        return sum(1.0 / K for _, K in self.stiffnesses)

    def gear(self, measured: float) -> float:
        """1/(1/K − Σ 1/K_i) [N·m/rad]; inf where the path alone is softer than what was measured."""
        rest = 1.0 / measured - self.compliance
        return 1.0 / rest if rest > 0 else float("inf")

    def words(self) -> str:
        """What was taken off."""
        return " and ".join(f"{what} {K:g} N·m/rad" for what, K in self.stiffnesses)


def path_of(values: Mapping[str, Any]) -> Path | None:
    """The declared series stiffnesses; None when there are none."""
    found = tuple((what, K) for key, what in SERIES.items() if (K := declared(values, key)) is not None)
    return Path(found) if found else None
