"""The pure kinematic error of another run of the same campaign, as a series to subtract."""

from __future__ import annotations

from rig.analysis.kinematic_error.measure import groups_by_speed, measure
from rig.analysis.motion.source import Source, motion_of
from rig.analysis.motion.strokes import find_strokes
from rig.core.units import ARCSEC
from rig.model.fourier import FourierSeries


def kinematic_error_reference(run: Source) -> FourierSeries | None:
    """θ̃_p(θ_m) [rad at the output] of a slow run, of the slowest speed it held; None when it has none to give."""
    motion = motion_of(run)
    if motion is None or motion.theta_l is None or not (strokes := find_strokes(motion)):
        return None
    groups = groups_by_speed(motion, strokes)
    most = max(sum(s.revolutions for s in g) for g in groups)
    slowest = next(g for g in groups if sum(s.revolutions for s in g) * 4 >= most)
    found = measure(run, motion, slowest, slow=True)
    if found is None:
        return None
    cosine, sine = found.profile.cosine * ARCSEC, found.profile.sine * ARCSEC
    return FourierSeries(tuple(map(float, cosine)), tuple(map(float, sine)))
