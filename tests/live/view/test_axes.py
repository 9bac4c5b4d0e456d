"""A plane with axes: where data lie in the picture."""

from __future__ import annotations

import numpy as np

from rig.live.view.axes import HEIGHT, WIDTH, Axis, Frame

X = Axis("angle", "deg", 0.0, 360.0, step=45.0)
Y = Axis("error", "arcsec", -60.0, 60.0)


def test_corners_of_the_data_are_corners_of_the_frame_with_y_upwards() -> None:
    points = Frame(X, Y).place(np.array([0.0, 360.0]), np.array([-60.0, 60.0]))
    assert points.tolist() == [[0.0, HEIGHT], [WIDTH, 0.0]]


def test_what_was_not_measured_is_no_point() -> None:
    assert len(Frame(X, Y).place(np.array([1.0, 2.0]), np.array([np.nan, 1.0]))) == 1


def test_every_number_stands_at_its_own_grid_line() -> None:
    frame = Frame(X, Y)
    where, words = frame.numbers()
    below = {word: x for (x, y), word in zip(where.tolist(), words, strict=True) if y > HEIGHT}
    assert below["180"] == WIDTH / 2
    assert len(frame.grid()) == len(words) == 9 + 7


def test_titles_carry_the_unit() -> None:
    assert Frame(X, Y).titles()[1] == ["angle [deg]", "error [arcsec]"]


def test_an_axis_grows_to_what_comes_and_shrinks_only_when_it_is_far_too_wide() -> None:
    grown = Y.fitted(-70.0, 40.0)
    assert grown.low <= -70.0
    assert grown.high >= 40.0
    assert Y.fitted(-40.0, 40.0) is Y
    assert Y.fitted(-3.0, 3.0).high < 10.0
    assert Y.fitted(np.nan, 1.0) is Y


def test_a_constant_has_an_axis_too() -> None:
    axis = Y.fitted(200.0, 200.0)
    assert axis.low < 200.0 < axis.high
