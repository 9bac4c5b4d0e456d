"""Whether the drive's torque and the torque sensor agree on what a load takes: if not, one of their gains is off."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from typing import Final

import numpy as np

from rig.analysis.identify.means import Mean

OFF: Final = 0.15  # friction that grows with the load takes a tenth of it at most
SURELY: Final = 4.0  # standard deviations
SPAN: Final = 2.0  # N·m at the output, by which the torque has to differ at a speed
LIKE: Final = 1.3  # times another speed: friction is the same to a few hundredths


def disagreement(means: Sequence[Mean], ratio: float) -> str:
    """Why one of two gains seems to be off, a sentence; "" where they agree or nothing tells.

    Of stretches at a like speed and of one way, what τ_m has beyond τ_l/N is the same whatever τ_l is.
    """
    known = [m for m in means if np.isfinite([m.motor, m.load]).all() and m.omega]
    alike = defaultdict(list)
    for m in known:
        alike[m.way, round(np.log(abs(m.omega)) / np.log(LIKE))].append((m.motor, (m.load - m.tau_ext) / ratio))
    groups = [np.array(group) for group in alike.values() if len(group) > 1]
    if not groups or max(float(np.ptp(g[:, 1])) for g in groups) < SPAN / ratio:
        return ""
    y, x = np.concatenate([g - g.mean(0) for g in groups]).T
    slope = float(x @ y / (x @ x))
    freedom = sum(len(g) - 1 for g in groups) - 1
    u = float(np.sqrt(np.sum((y - slope * x) ** 2) / max(freedom, 1) / (x @ x)))
    if abs(slope) < max(OFF, SURELY * u):
        return ""
    return (
        f"For every N·m that the torque sensor shows more the drive gives {1 + slope:.2f} ± {1.96 * u:.2f} N·m, "
        "reckoned to the output, expected about 1: the gain of one of them is off, or its unit (1 lbf·ft is 1.36 N·m); "
        "K, J_l, B_l, B_sp and F_cl go by the one, J_m, B_m and tau_c by the other."
    )
