"""Plan, bench and seed → the list of runs. The one planner: a dry run prints what it gives, a campaign makes it."""

from __future__ import annotations

import math
import secrets
from dataclasses import dataclass
from pathlib import Path

from rig.bench import Bench
from rig.campaign.order import shuffled, with_sentinels
from rig.campaign.plan import Plan
from rig.campaign.steps import Item, extra_items, items_of
from rig.campaign.swing import into_resonance, swing
from rig.core.errors import NotReady
from rig.core.procedure import Envelope
from rig.core.units import ARCMIN
from rig.refusals import refuse_beyond_limits, refuse_endless

SEEDS = 2**31
ROLE = {"theta_l": "load_encoder", "tau_l": "torque_sensor"}  # which device gives which channel


@dataclass(frozen=True)
class Campaign:
    """All that is to be done, in order."""

    plan: Plan
    bench: Bench
    seed: int
    items: tuple[Item, ...]

    def envelope(self, item: Item) -> Envelope:
        """What a run will ask for at most."""
        return item.procedure.envelope(self.bench.setting(lambda text: None))

    def shaft_torque(self, item: Item) -> float:
        """The most the torque sensor is expected to carry [N·m]: what a lock test winds up, or weight and swing."""
        envelope = self.envelope(item)
        if item.rigging.output_locked:
            return 0.0 if math.isinf(envelope.shaft_torque) else envelope.shaft_torque
        return abs(item.rigging.tau_ext) + self.swing(item)

    def swing(self, item: Item) -> float:
        """Predicted amplitude [N·m] of order 2 in the shaft torque up to the speed of the run; 0 when locked."""
        if item.rigging.output_locked:
            return 0.0
        amplitude = self.plan.file.order_2_arcmin * ARCMIN
        return swing(self.bench.declared_gear, amplitude, self.envelope(item).speed)


def any_seed() -> int:
    """Of an order of runs, drawn when none is given."""
    return secrets.randbelow(SEEDS)


def planned(plan: Plan, bench: Bench, seed: int) -> Campaign:
    """The runs of `plan` on `bench`, in the order `seed` gives. Raises UsageError and NotReady: see `refuse`."""
    source = Path(plan.source).name
    items = items_of(plan.file, source)
    unordered = Campaign(plan, bench, seed, tuple(items))
    for item in items:
        refuse(unordered, item)
    if plan.file.order == "random":
        items = shuffled(items, seed)
    if plan.file.sentinel:
        sentinel = extra_items("sentinel", plan.file.sentinel, source)
        refuse(unordered, sentinel[0])
        items = with_sentinels(items, sentinel, plan.file.sentinel.at, lambda item: unordered.envelope(item).duration)
    if plan.file.warm_up:
        warm_up = extra_items("warm-up", plan.file.warm_up, source)
        refuse(unordered, warm_up[0])
        items = [*warm_up, *items]
    return Campaign(plan, bench, seed, tuple(items))


def refuse(campaign: Campaign, item: Item) -> None:
    """Raises UsageError for an endless run, NotReady for one the bench does not allow, before anything moves."""
    bench, procedure = campaign.bench, item.procedure
    refuse_endless(bench, procedure)
    missing = [c for c in procedure.needs if c in ROLE and getattr(bench.file.devices, ROLE[c]) is None]
    if missing:
        raise NotReady(f"{item.words()}: {bench.source} has no {ROLE[missing[0]].replace('_', ' ')}, which it needs")
    if item.rigging.tau_ext and bench.file.devices.torque_sensor is None:
        raise NotReady(f"{item.words()}: {bench.source} has no torque sensor, which has to show the weight")
    try:
        refuse_beyond_limits(bench, procedure)
    except NotReady as error:
        raise NotReady(f"{item.words()}: {error}") from None
    _refuse_resonance(campaign, item)
    limit, asked = bench.limits.shaft_torque, campaign.shaft_torque(item)
    if limit is not None and asked > limit:
        raise NotReady(
            f"{item.words()}: {asked:.1f} N·m are expected at the torque sensor ({campaign.swing(item):.1f} N·m of it "
            f"swing), the bench allows {limit:g} N·m"
        )


def _refuse_resonance(campaign: Campaign, item: Item) -> None:
    if item.rigging.output_locked or item.allow_resonance:
        return
    amplitude = campaign.plan.file.order_2_arcmin * ARCMIN
    if words := into_resonance(campaign.bench, campaign.envelope(item), amplitude):
        raise NotReady(f"{item.words()}: {words}, or allow_resonance = true in the step")
