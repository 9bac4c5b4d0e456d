"""The series another run is corrected with."""

from __future__ import annotations

import numpy as np

from rig.analysis.kinematic_error.reference import kinematic_error_reference
from tests.analysis.stiffness.plant import LockedGear
from tests.analysis.synthetic import ARCSEC, PROFILE, slow_run


def test_the_series_of_a_slow_run_is_the_gears_own() -> None:
    found = kinematic_error_reference(slow_run(seed=4))
    assert found is not None
    grid = np.linspace(0, 2 * np.pi, 500)
    rest = (found.value(grid) - PROFILE.value(grid)) * ARCSEC
    assert np.abs(rest - rest.mean()).max() < 0.6, "arcsec, of 93 peak to peak"


def test_a_run_without_a_whole_turn_has_none_to_give() -> None:
    assert kinematic_error_reference(LockedGear().run()) is None
