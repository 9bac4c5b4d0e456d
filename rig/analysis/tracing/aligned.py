"""What a trace begins with, the torque sensor's own delay taken off.

Strain gauges are read through a low-pass, often of 100 or 200 Hz: at 60 Hz what it lets through is a seventh or a
fifteenth of a turn behind. A column of the load's equation takes that to the first order. But the motor's equation goes
by the same reading, and beyond some 1 ms a second inertia or a compliance takes what is left. A delay that is longer
than most sensors' is taken off the reading itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.findings.collected import pm
from rig.analysis.tracing.fit.channels import INDEX, WHOLE
from rig.analysis.tracing.fit.model import solve
from rig.analysis.tracing.fit.parameters import baseline
from rig.analysis.tracing.prepared import Prepared, prepare
from rig.analysis.tracing.runs.campaign import Campaign, read_again
from rig.analysis.tracing.thresholds import LAG
from rig.core.errors import UsageError
from rig.core.units import TURN

PLAINLY: Final = 500.0  # nats by which it must be likelier: rows of a sensor with noise of its own are a tenth as many
ROUNDS: Final = 6  # each leaves a tenth of what the one before left
SETTLED: Final = 2e-5  # s
LONGEST: Final = 1.2e-3  # s, a low-pass of 190 Hz, or a mean of 2.4 ms: what is later is left to be named


def aligned(campaign: Campaign, hold_out: Sequence[str]) -> tuple[Campaign, Prepared]:
    """The campaign and what is prepared of it: as they are, or with the torque brought forward by its delay, which a
    note tells."""
    p = prepare(campaign, hold_out)
    if p.baseline.value("lag") < LAG or not _all_read(p):
        return campaign, p
    found = _brought_forward(campaign, hold_out, _late(p))
    # a load angle that is early looks the same beside the load
    if found is None or _left(found) > min(_left(p) - PLAINLY, _with_a_later_load(campaign, hold_out, _late(found))):
        return campaign, p
    note = delay_told(found)
    read = replace(found.campaign, notes=(*found.campaign.notes, note))
    return read, replace(found, campaign=read)


def _all_read(p: Prepared) -> bool:
    return all({"t", "tau_l"} <= run.has for run in p.campaign.runs)


def _late(p: Prepared) -> float:
    """How late the torque is read, s: what it was brought forward by, and what is left of that by the runs alone. What
    is believed of a sensor beforehand would hold back each step to it."""
    d = p.baseline.design
    believed = d.prior.copy()
    believed[INDEX["lag"]] = 0.0
    return d.forward + float(solve(d.gram + np.diag(believed), d.right)[INDEX["lag"]])


def _brought_forward(campaign: Campaign, hold_out: Sequence[str], late: float) -> Prepared | None:
    """Read again until nothing of the delay is left; None where it is no filter's, or the runs are others then."""
    for _ in range(ROUNDS):
        found = prepared_again(campaign, hold_out, late_torque=late) if 0 < late < LONGEST else None
        if found is None or abs(_late(found) - late) < SETTLED:
            return found
        late = _late(found)
    return None


def _with_a_later_load(campaign: Campaign, hold_out: Sequence[str], late: float) -> float:
    """What is left where it is the load angle that comes early by as much."""
    other = prepared_again(campaign, hold_out, late_load=-late)
    return float("inf") if other is None else _left(other)


def prepared_again(campaign: Campaign, hold_out: Sequence[str], **changed: float) -> Prepared | None:
    """The same runs, looked at as before but for what is `changed` of the looks; None where they are others then, or
    cannot be fitted so."""
    read = read_again(campaign, **changed)
    try:
        return None if read is None else prepare(read, hold_out)
    except UsageError:
        return None


def _left(p: Prepared) -> float:
    """How unlikely what the baseline leaves in fitted runs is: logarithms of mean squares, each channel by its rows."""
    s = p.baseline
    blocks = [[s.residual(key) for key in s.keys if key[1] == c] for c in WHOLE]
    e = [np.concatenate(mine) for mine in blocks if mine]
    return float(sum(x.size * np.log(np.mean(x**2)) for x in e))


def delay_told(p: Prepared) -> str:
    """How late, and which low-pass would make it so."""
    lag = next(q for q in baseline(p.baseline) if q.name == "lag")
    corner = np.sqrt(2.0) / TURN / lag.value  # of the second order, Butterworth's
    late = pm(1e3 * lag.value, 1e3 * (lag.ci95[1] - lag.ci95[0]) / 2, "ms")
    return (
        f"The torque sensor is read {late} after the angles in all runs, as much as a low-pass of {corner:.0f} Hz of "
        "its own delays it; that is taken off before all else, and is no missing effect."
    )
