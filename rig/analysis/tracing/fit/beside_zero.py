"""Constant friction where the motor turned one way only: with the zero of its torque it is one number."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import INDEX
from rig.analysis.tracing.fit.model import Solution, evened
from rig.core.quantiles import Z95
from rig.model.effect import Array, Parameter

ZERO: Final = {"tau_c": "tau_0", "tau_cl": "tau_l0"}
RESOLVED: Final = 0.9  # of a change of it that comes out in the fit; of two alike columns each takes a half


def beside_its_zero(p: Parameter, s: Solution, c: Array) -> Parameter:
    """A friction that the data tell, as it is; else friction and zero together, for a servo's zero is the smaller of
    the two, and it may as well be none of it or twice that. `c` (p, p) is the covariance of all that is fitted."""
    if p.name not in ZERO or _resolved(s, INDEX[p.name]) > RESOLVED:
        return p
    i, j = INDEX[p.name], INDEX[ZERO[p.name]]
    along = np.zeros(len(c))
    along[[i, j]] = 1.0, np.sign(s.design.gram[i, j])
    both = float(along[: s.x.size] @ s.x)
    half = Z95 * float(np.sqrt(max(0.0, float(along @ c @ along))))
    return replace(p, value=both, ci95=(min(both - half, 0.0), both + max(both, 0.0) + half))


def _resolved(s: Solution, i: int) -> float:
    """How much of a change of coefficient i comes out in it."""
    scaled, scale = evened(s.design.gram + np.diag(s.design.prior))
    return float(np.linalg.solve(scaled, s.design.gram[:, i] * scale * scale[i])[i])
