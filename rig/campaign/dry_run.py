"""What a campaign would do: per run and in total, with the margin to every limit. Writes nothing, moves nothing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from rig.bench import Bench
from rig.campaign.changes import ByHand, Deed, Measure, deeds
from rig.campaign.planner import Campaign
from rig.campaign.preview import margin, stored_energy
from rig.campaign.steps import Item
from rig.campaign.swing import resonance_speed
from rig.campaign.unseen import unseen
from rig.core.operator import Change, FreeOutput, HangWeight, LockOutput, Reassemble, Rigging
from rig.core.procedure import Procedure
from rig.core.units import RPM, TURN
from rig.procedures.lock_check import LockCheck
from rig.procedures.sign_and_scale import SignAndScale
from rig.procedures.weigh import Weigh
from rig.runfile.room import rows_bytes

CHANGE = 60.0  # s a person takes for one, a guess for the total; the twin's hand takes none


@dataclass(frozen=True)
class Figures:
    """Of one run. SI, motor side unless said otherwise."""

    duration: float  # s
    travel: float  # rad
    speed: float  # rad/s
    torque: float  # N·m at most, clamped there
    energy: float  # J stored at most: in motion, and wound up in the gear
    swing: float  # N·m at the torque sensor, predicted amplitude of order 2
    shaft_torque: float  # N·m at the torque sensor, weight or lock test and swing
    bytes: float


def figures(campaign: Campaign, item: Item) -> Figures:
    """What one run asks for at most."""
    envelope, bench = campaign.envelope(item), campaign.bench
    shaft = campaign.shaft_torque(item)
    return Figures(
        duration=envelope.duration,
        travel=envelope.travel,
        speed=envelope.speed,
        torque=envelope.torque,
        energy=stored_energy(bench, item.procedure, shaft),
        swing=campaign.swing(item),
        shaft_torque=shaft,
        bytes=rows_bytes(envelope.duration * bench.file.loop.rate),
    )


def checks_of(change: Change) -> list[Procedure]:
    """The runs that show a change."""
    match change:
        case HangWeight(tau_ext):
            return [Weigh(tau_ext)]
        case LockOutput():
            return [LockCheck()]
        case FreeOutput():
            return [LockCheck(), SignAndScale()]
        case Reassemble():
            return [SignAndScale(), Weigh()]
        case _:
            return [SignAndScale()]


def lines(campaign: Campaign, runs: Sequence[int] | None = None) -> Iterator[str]:
    """The table, the totals, what has to be known beforehand; of the runs numbered `runs` from 0, or all of them."""
    bench, plan = campaign.bench, campaign.plan.file
    numbers = range(len(campaign.items)) if runs is None else runs
    todo = list(deeds([(k, campaign.items[k]) for k in numbers], Rigging()))
    if not numbers:
        yield "every run is made: nothing is left to do"
        return
    simulated = "" if bench.by_person else " (SIMULATED)"
    yield f"campaign {plan.name} on {bench.file.name}{simulated}: {plan.title}".rstrip(": ")
    order = f"random within a rigging, seed {campaign.seed}" if plan.order == "random" else "as written"
    yield f"order {order}; a failed run: {plan.on_failure}; nothing is moved or written"
    yield ""
    heads = (("run", 4), ("duration", 10), ("travel", 13), ("speed", 11), ("torque ≤", 11), ("stored ≤", 10))
    more = (("swing ±", 11), ("shaft ≤", 11), ("size", 8))
    yield "".join(f"{head:>{width}s}" for head, width in (*heads, *more))
    yield "  -   sign-and-scale proof, then the unloaded torque sensor is weighed"
    for deed in todo:
        yield from _told(campaign, deed)
    yield ""
    yield from totals(campaign, todo)
    yield from unseen(campaign)


def _told(campaign: Campaign, deed: Deed) -> Iterator[str]:
    match deed:
        case ByHand(change):
            shown = " and ".join(check.title() for check in checks_of(change))
            yield f"  -   by hand: {change.words()}; then shown by {shown}"
        case Measure(index, item):
            f = figures(campaign, item)
            moves = f"{f.travel / TURN:7.1f} turns {f.speed / RPM:6.1f} rpm"
            loads = f"{f.torque:6.2f} N·m {f.energy:7.3f} J {f.swing:6.2f} N·m {f.shaft_torque:6.2f} N·m"
            yield f"{index + 1:4d} {f.duration:7.1f} s {moves} {loads} {f.bytes / 1e6:4.0f} MB  {item.words()}"
            for remark in item.procedure.remarks(campaign.bench.setting(lambda text: None)):
                yield f"      {remark}"


def totals(campaign: Campaign, todo: list[Deed]) -> Iterator[str]:
    """Sums, the least margins, and what was assumed."""
    bench = campaign.bench
    items = [deed.item for deed in todo if isinstance(deed, Measure)]
    found = [figures(campaign, item) for item in items]
    by_hand = [deed for deed in todo if isinstance(deed, ByHand)]
    duration, checking, hand = lasting(campaign, todo)
    size = sum(f.bytes for f in found) + rows_bytes(checking * bench.file.loop.rate)
    yield f"total       {len(found)} runs, {len(by_hand)} changes by hand, {len(checks_in(bench, by_hand))} checks"
    yield (
        f"duration    {_time(duration + checking + hand)}: {_time(duration)} of runs, {_time(checking)} of checks"
        + (f", about {_time(hand)} by hand" if hand else " of rig time")
    )
    yield f"size        about {size / 1e6:.0f} MB"
    for what, asked, limit, unit in asked_of(bench, found):
        clamped = f"torque      at most {asked:g} N·m (clamped), limit {limit:g} N·m"
        yield clamped if what == "torque" else _margin(what, asked, limit, unit)
    yield f"stored      at most {max(f.energy for f in found):.3f} J, in motion and wound up in the gear"
    at = resonance_speed(bench.declared_gear) / RPM
    yield (
        f"predicted   the swing, from the declared gear (order 2 resonates at {at:.0f} rpm of the motor) and "
        f"{campaign.plan.file.order_2_arcmin:g} arcmin of order 2, zero to peak; damping and inertias as declared"
    )
    heaviest = max(abs(item.rigging.tau_ext) for item in items)
    if heaviest:
        loaded = [f.travel for f, item in zip(found, items, strict=True) if item.rigging.tau_ext]
        turns = 2 * max(loaded) / TURN / bench.file.gear.N
        yield (
            f"weights     at most {heaviest:g} N·m, {heaviest / bench.file.gear.N:.2f} N·m at the motor: refused if "
            f"the proof finds a gear that might not hold it; it travels {turns:.2f} turns of the output at most"
        )


def checks_in(bench: Bench, by_hand: Sequence[ByHand]) -> list[Procedure]:
    """Proof, the unloaded weighing, and what shows each change."""
    tare: list[Procedure] = [Weigh()] if bench.limits.shaft_torque else []
    return [SignAndScale(), *tare, *(check for deed in by_hand for check in checks_of(deed.change))]


def lasting(campaign: Campaign, todo: Sequence[Deed]) -> tuple[float, float, float]:
    """s of runs, of checks, and that a person takes for the changes."""
    setting, by_hand = campaign.bench.setting(lambda text: None), [deed for deed in todo if isinstance(deed, ByHand)]
    checking = sum(check.envelope(setting).duration for check in checks_in(campaign.bench, by_hand))
    runs = sum(campaign.envelope(deed.item).duration for deed in todo if isinstance(deed, Measure))
    return runs, checking, CHANGE * len(by_hand) if campaign.bench.by_person else 0.0


def asked_of(bench: Bench, found: Sequence[Figures]) -> list[tuple[str, float, float, str]]:
    """(what, the most that any of the runs asks for, limit, unit); "torque" is where the loop is clamped."""
    limits = bench.limits
    asked = [
        ("travel", max(f.travel for f in found) / TURN, limits.travel / TURN, "turns"),
        ("speed", max(f.speed for f in found) / RPM, limits.speed / RPM, "rpm"),
        ("torque", max(f.torque for f in found), limits.torque, "N·m"),
    ]
    if limits.shaft_torque is not None:
        asked.append(("shaft", max(f.shaft_torque for f in found), limits.shaft_torque, "N·m"))
    return asked


def _margin(what: str, asked: float, limit: float, unit: str) -> str:
    return f"{what:11s} at most {asked:.1f} of {limit:g} {unit}, {margin(asked / limit)}"


def _time(seconds: float) -> str:
    return f"{seconds / 60:.1f} min" if seconds >= 120 else f"{seconds:.0f} s"
