"""The motor's reference that puts the output where a gear without error would have it."""

import numpy as np
import pytest

from rig.core.errors import UsageError
from rig.model.fourier import FourierSeries
from rig.procedures.compensated import Compensated, Inverse

A, B, RATIO = (2e-5, 9e-5, 5e-6), (-1e-5, -1.6e-4, 3e-6), 50.0  # rad: a hundred arcsec peak to peak


def test_the_output_of_the_reference_is_where_an_ideal_gear_would_have_it() -> None:
    inverse, series = Inverse(A, B, RATIO), FourierSeries(A, B)
    x = np.linspace(-20.0, 20.0, 500)
    theta = np.array([inverse.solve(v, v)[0] for v in x])
    assert theta / RATIO - series.value(theta) == pytest.approx(x / RATIO, abs=1e-10)


def test_its_speed_is_the_slope_of_its_way() -> None:
    inverse, h = Inverse(A, B, RATIO), 1e-5
    theta, gain = inverse.solve(3.0, 3.0)
    assert gain == pytest.approx((inverse.solve(3.0 + h, theta)[0] - theta) / h, rel=1e-4)


def test_without_coefficients_the_motor_goes_where_it_would_have_gone() -> None:
    assert Inverse((), (), RATIO).solve(1.25, 0.0) == (1.25, 1.0)


def test_forth_and_back_end_where_they_began() -> None:
    procedure = Compensated(60.0, 3)
    way = procedure.way()
    at = [procedure._at(way, t) for t in np.arange(0.0, 2 * way.duration + 1.5, 0.01)]
    assert max(offset for offset, _, _ in at) == pytest.approx(way.distance)
    assert at[-1][0] == pytest.approx(0.0, abs=1e-9)


def test_an_error_too_steep_to_be_a_gear_s_is_refused() -> None:
    from rig.bench import read

    with pytest.raises(UsageError, match="no gear"):
        next(Compensated(a=(0.02,), b=(0.0,)).steps(read("twin").setting(lambda text: None)))


def test_coefficients_come_in_pairs() -> None:
    with pytest.raises(UsageError, match="as many"):
        Compensated(a=(1e-5,), b=())
