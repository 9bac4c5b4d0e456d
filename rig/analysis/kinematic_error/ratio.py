"""Do both angles belong to a gear of the declared ratio?"""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.angle import measured_ratio
from rig.analysis.motion.mistaken import mistaken
from rig.analysis.motion.source import Motion
from rig.core.units import DEG, TURN

SAME = 0.01  # relative: no wind-up and no kinematic error over a stroke of half an output turn is more
NEAR = 0.001  # the same where θ_l misses by more than a kinematic error can:
ERROR = 2e-3  # rad at the output, 7 arcmin from end to end: gears of the kind have 1 to 2
LOOKED_AT = 20_000  # rows: a slope needs no more


def turns_per_turn(motion: Motion, torsion: Array | None = None) -> float:
    """Turns of the motor to one of the load, as both encoders say, the load angle less its share of `torsion`
    τ_l/K [rad] of the rows that are looked at, where that is given; nan without a load angle."""
    if motion.theta_l is None:
        return float("nan")
    some = _looked_at(motion)
    load = motion.theta_l[some] if torsion is None else motion.theta_l[some] + torsion
    return float(measured_ratio(motion.theta_m[some], load))


def _looked_at(motion: Motion) -> slice:
    """Rows that a slope is read from."""
    return slice(None, None, max(motion.theta_m.size // LOOKED_AT, 1))


def disagreement(motion: Motion, turns: float | None = None) -> str:
    """Why θ̃ would be nonsense: the angles, `turns` to one, are not of a gear of this ratio. Empty when they are."""
    if motion.theta_l is None:
        return ""
    turns = turns_per_turn(motion) if turns is None else turns
    if abs(turns / motion.ratio - 1.0) < SAME:
        return ""
    if abs(turns / motion.ratio + 1.0) < SAME:
        return "The load angle runs against the motor: flip the sign of one encoder, θ̃ is twice the motion until then."
    if not np.ptp(motion.theta_l):
        gone = float(np.ptp(motion.theta_m)) / TURN
        return f"The load angle does not move while the motor goes {gone:.3g} turns: θ̃ means nothing."
    why = mistaken(motion.ratio, turns)
    said = f"The encoders say {turns:.5g} motor turns per load turn, the manifest says {motion.ratio:g}"
    return f"{said}: θ̃ means nothing{f'; {why}' if why else ''}."


def doubt(motion: Motion, tau_l: Array | None, K: float | None) -> str:
    """Why θ̃ may be that of another ratio: what grows with the angle is more than a kinematic error has, and a torque
    that was measured does not bend the gear by it. Empty when it is no more; `tau_l` N·m (n,), `K` N·m/rad.
    """
    if motion.theta_l is None:
        return ""
    torsion = None if tau_l is None or K is None else tau_l[_looked_at(motion)] / K
    if torsion is not None and not np.isfinite(torsion).all():
        torsion = None
    turns, travel = turns_per_turn(motion), float(np.ptp(motion.theta_l))
    shown = [turns] if torsion is None else [turns, turns_per_turn(motion, torsion)]
    off = min(abs(motion.ratio / found - 1.0) for found in shown)
    if off < NEAR or off * travel < ERROR:
        return ""
    wound = "unless a load that changes with the angle winds the gear up" if torsion is None else "wind-up taken off"
    return (
        f"The encoders turn {turns:.5g} to 1, declared {motion.ratio:g}: θ̃ grows by {off * travel / DEG:.2g}° over the "
        f"{travel / DEG:.3g}° of the output, expected below {ERROR / DEG:.2g}° ({wound}). Another ratio, or another "
        "number of counts to a turn."
    )
