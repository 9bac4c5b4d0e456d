"""What the depth of the wave generator does to the kinematic error, and what a re-assembly alone does."""

from __future__ import annotations

from dataclasses import dataclass, field

from rig.campaign.plan import StepSection
from rig.campaign.sweeps import Sweep


@dataclass(frozen=True)
class AssemblySweep(Sweep):
    """The slow triangle under a few weights at each depth      [ghorbel2001, Fig. 10]

    The wave generator is fitted anew for every depth, and `reference` times at depth 0: an effect of the depth is one
    that is larger than what fitting it again at the same depth does.
    """

    depths_mm: tuple[float, ...] = field(default=(0.15, 0.3), metadata={"signed": True})  # deeper than the reference
    reference: int = 3  # assemblies at the reference depth
    weights: tuple[float, ...] = field(default=(0.0, 1.0, 3.0, 7.5, 15.0), metadata={"signed": True})  # N·m each
    amplitude_deg: float = 1440.0  # deg of the motor, zero to peak
    frequency: float = 0.01  # Hz, of the triangle
    cycles: float = 1.0  # under each weight

    def sections(self) -> list[StepSection]:
        """The reference depth as often as asked, then each of the others once."""
        depths = (0.0,) * self.reference + self.depths_mm
        return [section for k, depth in enumerate(depths) for section in self._at(depth, fit_anew=k > 0)]

    def _at(self, depth_mm: float, fit_anew: bool) -> list[StepSection]:
        triangle = {"amplitude_deg": self.amplitude_deg, "frequency": self.frequency, "cycles": self.cycles}
        return [
            StepSection.model_validate(
                {
                    "procedure": "kinematic-error", "with": triangle, "weight": weight, "depth_mm": depth_mm,
                    "reassemble": fit_anew and k == 0, "note": f"assembly sweep, depth {depth_mm:+g} mm",
                }
            )
            for k, weight in enumerate(sorted(self.weights, key=abs))
        ]  # fmt: skip
