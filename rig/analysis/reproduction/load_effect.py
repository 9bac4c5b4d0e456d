"""Why the model misses more at 500 rpm: the pure error as Fig. 9 has it under the torque that turns the load there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.claim import Claim, at_most, missing
from rig.analysis.reproduction.model import Model
from rig.analysis.reproduction.reading import Reading
from rig.analysis.reproduction.shaft import Complex
from rig.analysis.reproduction.split import Split, simulate
from rig.analysis.reproduction.ways import Way
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear

HALF = 0.7  # of the rms: half of the mean square has to go, or it is not the main reason
WHY = "…because the pure error depends on the load, and the load is more there"
NOTHING = "It takes the torque sensor, slow runs under several loads, and a model."


@dataclass(frozen=True)
class UnderLoad:
    """The model again, with `kept` of its θ̃_p: what slow runs under load say is left at the torque carried there."""

    simulated: Complex  # θ̃, arcsec
    kept: float
    before: float  # N·m carried in the slow run
    there: float  # N·m carried in the run at speed
    swing: float  # N·m, peak to peak, in the run at speed


def under_load(campaign: Campaign, split: Split | None) -> UnderLoad | None:
    """None without torque sensor, slow runs under loads on both sides of that torque, or a model."""
    pure = campaign.pure()
    if split is None or split.left is None or campaign.model is None or pure is None or split.reading.shaft is None:
        return None
    zero, shaft = _zero(campaign.model), split.reading.shaft
    curve, before, there = shrinking(loaded(campaign), zero), _carried(pure[0], zero), abs(shaft.mean - zero)
    if (
        curve is None
        or before is None
        or not curve[0].min() <= min(before, there) <= max(before, there) <= curve[0].max()
    ):
        return None
    kept = float(np.interp(there, *curve) / np.interp(before, *curve))
    again = simulate(scaled(campaign.model, kept), split.fast, split.decomposition)
    return None if again is None else UnderLoad(again[0], kept, before, there, shaft.swing)


def loaded(campaign: Campaign) -> list[Way]:
    """Slow runs of the assembly that was run at speed, each direction by itself, at the speed of the pure error."""
    pure = campaign.pure()
    assert pure is not None
    near = 1.15 * pure[1].speed_rpm
    here = [r for r in campaign.readings if r.slow and r.assembly == campaign.assembly]
    return [w for r in here if near / 1.15**2 <= r.slow[0].speed_rpm <= near for w in r.ways]


def shrinking(ways: Sequence[Way], zero: float) -> tuple[Array, Array] | None:
    """(|τ_l| N·m, rms of θ̃ arcsec), rising in torque, equal torques averaged; None with fewer than three."""
    torque, size = np.array([abs(w.torque - zero) for w in ways]), np.array([w.size for w in ways])
    levels = np.unique(np.round(torque, 1))
    if levels.size < 3:
        return None
    each = [np.abs(torque - level) <= 0.05 + 1e-9 for level in levels]
    return np.array([torque[e].mean() for e in each]), np.array([size[e].mean() for e in each])


def scaled(model: Model, kept: float) -> Gear:
    """The model's gear with `kept` of its θ̃_p."""
    s = model.gear.kinematic_error
    smaller = FourierSeries(tuple(kept * a for a in s.a), tuple(kept * b for b in s.b))
    return replace(model.gear, kinematic_error=smaller)


def why_worse(split: Split | None, again: UnderLoad | None) -> Claim:
    """Whether the load explains what the model leaves of θ̃."""
    left = None if split is None else split.rms_left()
    if split is None or left is None or again is None:
        return missing(WHY, NOTHING)
    after = replace(split, simulated=again.simulated).rms_left()
    assert after is not None
    told = (
        f"The gear carries {again.there:.2f} N·m there, swinging by {again.swing:.1f} N·m, and {again.before:.2f} N·m "
        f"in the slow run; slow runs under load say that {100 * again.kept:.1f} % of θ̃_p are then left. With that the "
        "model leaves {} instead of {}."
    )
    rule = f"What the model leaves with θ̃_p so scaled, over what it left before: rms at most {HALF:g}, half its square."
    return Claim(WHY, at_most(after.over(left), HALF), told, (after, left), rule)


def _carried(reading: Reading, zero: float) -> float | None:
    """Mean |τ_l| of a slow run over both directions, N·m."""
    sizes = [abs(w.torque - zero) for w in reading.ways]
    return float(np.mean(sizes)) if sizes else None


def _zero(model: Model) -> float:
    """Of the torque sensor, N·m; 0 where it could not be told."""
    zero = model.parameters.get("zero")
    return 0.0 if zero is None else zero.value
