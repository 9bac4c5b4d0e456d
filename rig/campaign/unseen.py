"""What a simulated rig cannot show of what a campaign asks it, because its bench file gives the twin no such effect."""

from __future__ import annotations

from collections.abc import Iterator

from rig.campaign.planner import Campaign
from rig.config.twin import TwinSection
from rig.procedures.kinematic_error import KinematicError

LOADS = 4  # from as many on a law of the load is fitted: fewer are hung for other reasons


def unseen(campaign: Campaign) -> Iterator[str]:
    """A sentence for each question of the campaign that its twin answers with nothing; none about a real rig."""
    twin = campaign.bench.file.twin if campaign.bench.simulated else None
    if twin is None:
        return
    slow = [item.rigging for item in campaign.items if isinstance(item.procedure, KinematicError)]
    name = campaign.bench.file.name
    if len({rigging.tau_ext for rigging in slow}) >= LOADS and not by_load(twin):
        yield (
            f"bench '{name}' simulates no effect of the load on the kinematic error (twin.effects.load_dependent_error."
            "A_inf = 1): its peak to peak will be the same under every weight. What the paper saw in Fig. 9 is "
            "simulated by --bench twin-paper."
        )
    if len({rigging.depth_mm for rigging in slow}) > 1 and not by_depth(twin):
        yield (
            f"bench '{name}' simulates no effect of assembly on the kinematic error (twin.effects.assembly: "
            "error_per_mm = 0 1/mm, scatter = 0): its peak to peak will be the same at every depth. What the paper saw "
            "in Fig. 10 is simulated by --bench twin-paper."
        )


def by_load(twin: TwinSection) -> bool:
    """Whether a weight changes the kinematic error of a slow run: directly, or by a spring that differs by angle."""
    effects = twin.effects
    return effects.load_dependent_error.A_inf != 1.0 or effects.stiffness.by_angle != 0.0


def by_depth(twin: TwinSection) -> bool:
    """Whether fitting the wave generator again, or deeper, changes the kinematic error."""
    assembly = twin.effects.assembly
    return any((assembly.error_per_mm, assembly.scatter, assembly.scatter_deg))
