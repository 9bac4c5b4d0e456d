"""Equation 1 and its sign."""

from __future__ import annotations

import numpy as np

from rig.core.units import ARCSEC, TURN
from rig.model.transmission_error import transmission_error


def test_the_error_is_positive_when_the_load_lags_and_is_measured_at_the_output() -> None:
    """θ̃ = θ_m/N − θ_l: one motor turn of 50 and a load 10 arcsec short of 7.2 degrees is +10 arcsec."""
    error = transmission_error(np.array([TURN]), np.array([np.deg2rad(7.2) - 10 * ARCSEC]), 50.0)
    assert np.allclose(error / ARCSEC, 10.0, atol=1e-6)
