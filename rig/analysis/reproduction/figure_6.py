"""Fig. 6: what a series of k terms leaves of the pure kinematic error."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Array
from rig.analysis.kinematic_error.measure import KinematicError
from rig.analysis.kinematic_error.profile import truncation
from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.claim import Claim, Number, at_most, missing
from rig.analysis.reproduction.exhibit import Exhibit
from rig.analysis.reproduction.split import words
from rig.model.fourier import PAPER_ORDERS

UP_TO = 30  # terms drawn: twice as many show whether the curve has levelled off
LEFT = 0.01  # of the mean square: a tenth of the amplitude, what the paper's figure can show
TITLE = "Mean square error of the Fourier series"
PAPER = "MSE(k) falls with the number of terms k and has levelled off at fifteen: fifteen terms suffice."
CLAIM = "Fifteen terms suffice"
RULE = f"What fifteen terms leave of the mean square: at most {100 * LEFT:g} %, with its 95 % interval."


def figure(campaign: Campaign) -> Exhibit:
    """MSE(k) by Parseval from the mean curve, with the noise floor."""
    pure = campaign.pure()
    if pure is None:
        lacking = "It takes a slow run without load."
        return Exhibit("Figure 6", TITLE, PAPER, "", (missing(CLAIM, lacking),), missing=lacking)
    reading, error = pure
    mse = truncation(error.profile.pure(), UP_TO)
    curves = {
        "mse.k": np.arange(1.0, mse.size), "mse.value": mse[1:],
        "mse.floor": np.array([error.profile.floor]), "mse.chosen": np.array([float(PAPER_ORDERS)]),
    }  # fmt: skip
    how = f"{words(reading, error)}; the floor is what the scatter of single turns leaves in their mean."
    return Exhibit("Figure 6", TITLE, PAPER, how, (suffices(turns(error)),), "convergence", curves)


def turns(error: KinematicError) -> Array:
    """The curves of single revolutions (R, G), each about its mean; the two directions about a common mean."""
    sides = [[s.curves for s in error.strokes if s.direction == d] for d in (1, -1)]
    joined = [np.concatenate(side) for side in sides if side]
    level = np.mean([side.mean(axis=0) for side in joined], axis=0)
    return np.concatenate([side - side.mean(axis=0) + level for side in joined])


def suffices(revolutions: Array) -> Claim:
    """From single revolutions (R, G) arcsec: jackknife over them gives the interval      [efron1982]"""
    n = revolutions.shape[0]
    if n < 3:
        return missing(CLAIM, "Too few revolutions for an interval.")
    total = revolutions.sum(axis=0)
    value = _left(total / n)
    without = np.array([_left((total - one) / (n - 1)) for one in revolutions])
    half = t95(n - 1) * float(np.sqrt((n - 1) / n * np.sum((without - without.mean()) ** 2)))
    left = Number.of(1e6 * value, 1e6 * half, "ppm")
    return Claim(CLAIM, at_most(left, 1e6 * LEFT), "Fifteen terms leave {} of the mean square.", (left,), RULE)


def _left(curve: Array) -> float:
    mse = truncation(curve - curve.mean(), PAPER_ORDERS)
    return float(mse[PAPER_ORDERS] / mse[0])
