"""Identification: runs of a campaign to the parameters of equations 6-8, with intervals, and what stays undecided."""

from rig.analysis.identify.fit import Fits, fit
from rig.analysis.identify.identified import Identified, identified, order_amplitudes
from rig.analysis.identify.predictions import Prediction, predictions
from rig.analysis.identify.recording import Recording, recording

__all__ = [
    "Fits",
    "Identified",
    "Prediction",
    "Recording",
    "fit",
    "identified",
    "order_amplitudes",
    "predictions",
    "recording",
]
