"""A run that lies in a campaign twice under two names, as a copied folder does, is no repeat of itself.

Manifests of other loggers give no uid, and often no date; rows that are the same to the last bit, begun at the same
time as far as anybody says, do as well. As a repeat it would make a floor of nothing, and a held-out run that was
fitted.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

from rig.analysis.tracing.runs.recording import Recording


def same_rows(runs: Sequence[Recording]) -> dict[str, str]:
    """Why a run is left out, by its name: the first of those with the same rows stays."""
    first: dict[bytes, str] = {}
    out: dict[str, str] = {}
    for run in runs:
        seen = first.setdefault(_rows(run), run.name)
        if seen != run.name:
            out[run.name] = f"it holds the same rows as {seen}, begun at the same time"
    return out


def _rows(run: Recording) -> bytes:
    digest = hashlib.blake2b(str(run.start).encode())
    for piece in run.pieces:
        for x in (piece.theta_m, piece.theta_l, piece.tau_m, piece.tau_l):
            digest.update(x.tobytes())
    return digest.digest()
