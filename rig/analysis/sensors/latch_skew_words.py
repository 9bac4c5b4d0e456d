"""Latch skew as a person is shown it: measured by a run of its own, and what it does to the θ̃ of another."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from rig.analysis.findings.collected import Findings, pm
from rig.analysis.findings.result import Estimate, Result
from rig.analysis.motion.declared import declared
from rig.analysis.motion.source import Motion, Source
from rig.analysis.sensors.latch_skew import Late, Wound, legs, load_encoder_late, pairs, torque_late
from rig.core.units import ARCSEC, RPM
from rig.model.gear import sigma_of

LABEL = "skew"  # of the runs that measure it
FEWEST = 4  # pairs: two parameters, and something left to see their scatter
LEVER = 1.0  # rad/s between the slowest and the fastest pair
MICRO = 1e6  # µs in a s


def add_latch_skew(found: Findings, run: Source, motion: Motion) -> None:
    """Add how much later than θ_m the θ_l of a row is latched, and τ_l after θ_l; says why where it cannot be had."""
    ref = motion.pick(run.column("theta_ref"))
    wound = _wound(run)
    if motion.t is None or motion.theta_l is None or ref is None or wound is None:
        _nothing(found, "It takes t, theta_m, theta_l, theta_ref and a declared stiffness K.")
        return
    ways = legs(motion.t, motion.theta_m, motion.theta_l, ref, motion.pick(run.column("tau_l")))
    both = pairs(ways, motion.ratio)
    if len(both) < FEWEST or np.ptp([p.omega for p in both]) < LEVER:
        _nothing(
            found, f"The run has {len(both)} legs there and back at constant speed, expected {FEWEST} at 2 speeds."
        )
        return
    load, torque = load_encoder_late(both, wound), torque_late(ways, both, motion.ratio)
    _figures(found, load, torque, len(both))
    found.sentence = f"The load angle of a row is latched {_told(load)} after its motor angle" + (
        f", the shaft torque {_told(torque)} after the load angle (its own filter included)." if torque else "."
    )
    found.tables["skew_legs"] = [
        {"speed_rpm": p.omega / RPM, "odd_part_arcsec": p.odd / ARCSEC, "odd_torque_Nm": p.torque} for p in both
    ]
    if torque is None and run.has("tau_l"):
        found.cannot.append("The torque's time: no order of the motor shook the load clearly enough at these speeds.")


def bench_lines(result: Result) -> list[str]:
    """What to write into the bench file, TOML, after a run that measured latch skew; nothing after others."""
    known = {e.name: e for e in result.estimates}
    out = []
    for name, section in (("latch_skew_load", "load_encoder"), ("latch_skew_torque", "torque_sensor")):
        if (e := known.get(name)) is not None:
            value, half = e.value / MICRO, (e.ci95[1] - e.ci95[0]) / 2 / MICRO
            out += [f"[{section}]"] + [
                f'{key} = {{ value = {number:.3g}, unit = "s", from = "measured" }}'
                for key, number in (("skew", value), ("skew_half_width", half))
            ]
    return out


def _nothing(found: Findings, why: str) -> None:
    found.sentence = found.inconclusive = f"Latch skew was not measured. {why}"
    found.cannot.append(found.sentence)


def _wound(run: Source) -> Wound | None:
    gear, said = run.manifest.get("gear"), run.declared
    K, B_l, B_ml = (declared(said, key) for key in ("K", "B_l", "B_ml"))
    output = gear.get("output") if isinstance(gear, Mapping) else None
    return None if K is None else Wound(run.ratio, K, B_l or 0.0, B_ml or 0.0, sigma_of(output))


def _told(late: Late) -> str:
    return pm(MICRO * late.value, MICRO * late.half, "µs")


def _figures(found: Findings, load: Late, torque: Late | None, count: int) -> None:
    how = (
        f"Part of half of forward minus reverse that grows with the speed, over {count} pairs of legs on the same "
        "whole turns; wind-up by the torque sensed (K to 10 %) and by the declared B_ml (to a third) taken off."
    )
    found.figure(
        "latch_skew_load", "Load angle latched after motor angle", MICRO * load.value, "µs", MICRO * load.half, how
    )
    if torque is not None:
        how = (
            "Phase of the torque against J_l·θ̈_l + B_l·θ̇_l at the orders of the motor that shake the load; lag of the "
            "sensor's filter included, which makes it negative."
        )
        found.figure(
            "latch_skew_torque",
            "Shaft torque latched after load angle",
            MICRO * torque.value,
            "µs",
            MICRO * torque.half,
            how,
        )


def add_skew_error(found: Findings, run: Source, speed_rpm: float) -> None:
    """What latch skew does to θ̃ at `speed_rpm`: s·ω/N, forward the one way and reverse the other. Where it was not
    measured, that is said, and what a whole period of the loop would do.
    """
    if not np.isfinite(speed_rpm):
        return
    per_second = speed_rpm * RPM / run.ratio / ARCSEC  # arcsec at the output
    known = _known(run.manifest)
    if known is not None:
        value, half = abs(known.value) * per_second, known.half * per_second
        how = (
            f"Latch skew of the bench file, {_told(known)}, times the output's speed: moves θ̃ of the two directions "
            "apart by twice as much; the peak to peak of their even part keeps its value."
        )
        ci95 = (max(value - half, 0.0), value + half)
        label = "Shift of θ̃ by latch skew, each direction"
        found.estimates.append(Estimate("latch_skew_error", label, value, "arcsec", ci95, how))
        found.sentence += (
            f" Latch skew moves θ̃ by {value:.2g} ± {half:.2g} arcsec, opposite ways in the two directions."
        )
        return
    period = _period(run.manifest)
    if not period:
        found.cannot.append(
            "Latch skew between motor and load angle was not measured, nor the period of the loop told."
        )
        return
    found.sentence += (
        f" Latch skew was not measured (hdrig run skew): one period of {1000 * period:.3g} ms would move θ̃ by "
        f"{_two_digits(period * per_second)} arcsec, opposite ways in the two directions."
    )


def _two_digits(value: float) -> str:
    """4.1, 140: two significant digits without a power of ten."""
    return f"{float(f'{value:.2g}'):g}"


def _known(manifest: Mapping[str, Any]) -> Late | None:
    """The skew of θ_l the bench file tells [s]."""
    told = manifest.get("latch_skew")
    one = told.get("theta_l") if isinstance(told, Mapping) else None
    if not isinstance(one, Mapping):
        return None
    try:
        late = Late(float(one["value"]), float(one["half_width"]))
    except (KeyError, TypeError, ValueError):
        return None
    return late if np.isfinite(late.value) and late.half >= 0.0 else None


def _period(manifest: Mapping[str, Any]) -> float:
    """s between rows by the manifest; 0 when it does not say."""
    loop = manifest.get("loop")
    rate = declared(loop, "rate") if isinstance(loop, Mapping) else None
    return 1.0 / rate if rate else 0.0
