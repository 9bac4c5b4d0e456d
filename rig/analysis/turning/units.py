"""Was the motor angle recorded in the unit it is declared in? The speed that was commanded tells. And are time and
torques those of any gear?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.declared import FAR
from rig.analysis.motion.source import Motion, Source
from rig.analysis.motion.strokes import Stroke
from rig.analysis.smoothness.measure import nominal_rpm
from rig.core.numbers import number
from rig.core.plausible import PERIOD, TORQUE
from rig.core.rows import spread, stretches
from rig.core.units import DEG, TURN
from rig.model.transmission_error import transmission_error

FACTORS = (
    (1 / DEG, "theta_m", "180/π: is theta_m in deg"),
    (DEG, "theta_m", "π/180: was theta_m turned from deg into rad twice"),
    (1 / TURN, "theta_m", "1/(2π): is theta_m in turns"),
    (TURN, "theta_m", "2π: was theta_m multiplied by 2π twice"),
    (60.0, "theta_m", "60: is theta_m in sixtieths of what it should be, or t in min"),
    (1 / 60, "theta_m", "1/60: is a rate per minute read as one per second"),
    (1e-3, "t", "1/1000: is t in ms"),
    (1e3, "t", "1000: was t turned from ms into s twice"),
)
LOOKED_AT = 10_000  # rows: of a run of hours a unit needs no more
NEAR = 0.03  # share by which a speed may differ from that of a wrong unit: a loop follows better than that


def wrong_unit(motion: Motion, strokes: list[Stroke], reference: Array | None, conditions: Mapping[str, Any]) -> str:
    """Says which unit theta_m or t seems to be in, where its strokes are faster or slower than commanded by the factor
    of a unit; "" where they are not. Commanded is what `reference` [rad], shape (n,), does, without it
    `conditions["speed_rpm"]`."""
    asked = abs(number(conditions.get("speed_rpm")))
    if reference is not None and np.isfinite(reference).all():
        asked = nominal_rpm(motion, strokes, reference)
    rpm = nominal_rpm(motion, strokes, None)
    for factor, whose, what in FACTORS:
        if asked > 0 and abs(rpm / asked / factor - 1) < NEAR:
            return (
                f"The unit of {whose} looks wrong: the motor turns at {rpm:.4g} rpm and {asked:.4g} rpm were "
                f"commanded, a factor of {what}? Expected {'s' if whose == 't' else 'rad'}."
            )
    return ""


def unlikely_time(motion: Motion) -> str:
    """That no rig is read so slowly or fast; "" where it may be. The same bounds refuse a file at import."""
    if motion.t is None or motion.t.size < 2:
        return ""
    at = spread(motion.t.size - 1, LOOKED_AT)
    apart = float(np.median(motion.t[at + 1] - motion.t[at]))
    if PERIOD[0] <= apart <= PERIOD[1]:
        return ""
    return (
        f"The unit of t may be another one: {apart:.3g} s between rows, expected {PERIOD[0]:g} to {PERIOD[1]:g} s; "
        "speeds and durations go by it."
    )


def unlikely_torque(run: Source) -> Iterator[str]:
    """What of torques no gear has, a sentence each: what goes by them is another, what goes by angles is not. The same
    bounds refuse a file at import."""
    for name, limit in TORQUE.items():
        peak = _highest(run.column(name))
        if peak > limit:
            yield (
                f"The unit of {name} may be another one: it reaches {peak:.4g} N·m, expected below {limit:g} N·m; "
                "stiffness, friction and what hangs on the output go by it."
            )


def winds_too_far(motion: Motion, tau_l: Array | None, K: float | None) -> str:
    """That the gear would have to wind up further than it does, were `tau_l` [N·m] in its unit and `K` [N·m/rad] that
    of this gear; "" where it need not, or where one of them is not known. θ̃ swings by more than the wind-up alone at
    speed and with backlash, never by so much less."""
    if tau_l is None or motion.theta_l is None or K is None:
        return ""
    at = spread(motion.theta_m.size, LOOKED_AT)
    if not np.isfinite(tau_l[at]).any():
        return ""
    torque = _swing(tau_l[at])
    error = _swing(transmission_error(motion.theta_m[at], motion.theta_l[at], motion.ratio))
    if torque < FAR * K * error:
        return ""
    return (
        f"The unit of tau_l may be another one: it swings by {torque:.4g} N·m, which would wind a gear of the declared "
        f"K = {K:.4g} N·m/rad up by {torque / K / DEG:.3g} deg, and θ̃ swings by {error / DEG:.3g} deg; stiffness and "
        "what hangs on the output go by it."
    )


def _highest(x: Array | None) -> float:
    """Of |x|, (n,), where it was read."""
    parts = [] if x is None else [x[some] for some in stretches(x.size)]
    return max((float(np.fmax.reduce(np.abs(part), initial=0.0)) for part in parts), default=0.0)


def _swing(x: Array) -> float:
    """From the lowest hundredth of its values to the highest: a value read wrongly now and then is no swing."""
    low, high = np.nanpercentile(x, (1, 99))
    return float(high - low)
