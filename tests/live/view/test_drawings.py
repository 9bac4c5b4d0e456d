"""The pictures: kinematic error over a turn, trails, orders, the rig."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from rig.live.view.axes import HEIGHT, WIDTH
from rig.live.view.folded import Folded
from rig.live.view.layout import layout_for
from rig.live.view.orders import Orders
from rig.live.view.picture import Picture, absent, page, panes
from rig.live.view.space import CUP, DRAWN, Space, deflection, material
from rig.live.view.trail import STRIBECK, WIND_UP, Trail, averaged, loss
from rig.live.view.turns import BINS, Turns
from tests.live.view.kept import ABOUT, Kept, block, turning


def folded(rows: Any, pieces: int = 1) -> Kept:
    canvas, drawing = Kept(), Folded(50.0, "SIMULATED")
    drawing.draw(0.0, canvas)
    for piece in rows.slices(-(-len(rows) // pieces)):
        drawing.add(piece, canvas)
    return canvas


def heights(line: np.ndarray[Any, Any], words: list[str]) -> np.ndarray[Any, Any]:
    """The picture's y back in the unit of the axis, by the numbers that stand beside it."""
    numbers = [float(w.replace("−", "-")) for w in words[9:]]
    return np.asarray(numbers[0] + (1 - line[:, 1] / HEIGHT) * (numbers[-1] - numbers[0]))


def test_the_mean_over_a_turn_has_the_amplitude_and_the_place_of_the_line_in_the_data() -> None:
    canvas = folded(turning(5.5, 40.0))
    mean = heights(canvas.shown["/folded/forward/mean"][0], canvas.shown["/folded/frame/numbers"])
    angle = np.radians(np.arange(BINS) + 0.5)
    assert mean == pytest.approx(40.0 * np.cos(2 * angle), abs=1.0)
    assert canvas.shown["/folded/forward/words"] == ["forward, mean of 4 turns"]  # the first began nowhere
    assert "80" in canvas.shown["/folded/peak"][0]


def test_a_picture_of_many_small_blocks_is_that_of_one_large_one() -> None:
    rows = turning(5.5, 40.0)
    one, many = (
        heights(canvas.shown["/folded/forward/mean"][0], canvas.shown["/folded/frame/numbers"])
        for canvas in (folded(rows), folded(rows, 173))
    )
    assert many == pytest.approx(one, abs=1e-3)


def test_reverse_turns_are_kept_apart_from_forward_ones() -> None:
    canvas = folded(turning(4.5, 40.0, way=-1))
    assert "/folded/reverse/mean" in canvas.shown
    assert "/folded/forward/mean" not in canvas.shown


def test_simulated_stands_in_every_plane_and_in_the_rig() -> None:
    canvas = folded(turning(0.1, 1.0))
    assert canvas.shown["/folded/banner"] == ["SIMULATED"]
    Trail(WIND_UP, 50.0, "SIMULATED").draw(0.0, canvas)
    Space(ABOUT).draw(0.0, canvas)
    assert canvas.shown["/wind_up/banner"] == canvas.shown["/rig/banner"] == ["SIMULATED"]
    assert "SIMULATED" in page(ABOUT)
    assert "SIMULATED" not in page(replace(ABOUT, simulated=False))


def test_a_canvas_that_comes_late_is_given_what_stands() -> None:
    drawing, late = Folded(50.0, ""), Kept()
    drawing.add(turning(5.5, 40.0), Kept())
    drawing.draw(8.0, late)
    assert len(late.shown["/folded/forward/last"]) == 4


def test_a_turn_with_a_reversal_inside_is_none() -> None:
    forth = np.linspace(0.0, 3.5, 4000)
    theta = 2 * np.pi * np.concatenate((forth, forth[::-1]))
    done = Turns().add(theta, np.zeros_like(theta))
    assert [(turn.number, turn.way) for turn in done] == [(1, 1), (2, 1), (2, -1), (1, -1)]


def test_the_order_of_the_line_is_the_largest_bar_and_shows_its_amplitude() -> None:
    canvas, drawing = Kept(), Orders(50.0)
    drawing.add(turning(9.5, 40.0, order=4, n=20_000), canvas)
    orders, amplitude = canvas.shown["/orders"]
    assert orders[np.argmax(amplitude)] == 4.0
    assert amplitude.max() == pytest.approx(40.0, rel=0.05)


def test_a_trail_goes_through_its_points_and_its_colour_tells_the_way() -> None:
    canvas, drawing = Kept(), Trail(WIND_UP, 50.0, "")
    twist = np.radians(np.concatenate((np.linspace(0, 10, 3000), np.linspace(10, 0, 3000))) / 60)  # 10 arcmin and back
    drawing.add(block(6000, theta_m=twist * 50, theta_l=0.0, tau_l=twist * 7000), canvas)
    pieces = [lines for path, lines in canvas.shown.items() if path.startswith("/wind_up/trail")]
    assert len(pieces) >= 2
    assert all(len(line) > 10 for lines in pieces for line in lines)


@pytest.mark.slow
def test_a_trail_is_bounded_however_long_the_run() -> None:
    canvas, drawing = Kept(), Trail(STRIBECK, 50.0, "")
    rng = np.random.default_rng(2)
    for _ in range(30):
        drawing.add(block(50_000, omega_m=rng.normal(0, 50, 50_000), tau_applied=rng.normal(size=50_000)), canvas)
    pieces = [path for path in canvas.shown if path.startswith("/stribeck/trail")]
    assert 0 < len(pieces) <= 24


def test_means_leave_out_what_was_not_measured() -> None:
    t = np.arange(20) * 1e-3
    x = np.where(t < 0.005, np.nan, 1.0)
    assert averaged(t, x, np.ones(20), 0.01)[0].tolist() == [1.0, 1.0]


def test_the_flexspline_is_widest_along_the_wave_generator_and_stiff_at_its_floor() -> None:
    phi = np.array([0.3, 0.3 + np.pi / 2])
    assert deflection(phi, 0.3, 0.0).tolist() == pytest.approx([CUP + DRAWN, CUP - DRAWN])
    assert deflection(phi, 0.3, 34.0).tolist() == pytest.approx([CUP, CUP])


def test_the_rig_turns_as_measured_and_the_output_against_the_wave_generator() -> None:
    canvas = Kept()
    Space(ABOUT).add(turning(1.0, 0.0), canvas)
    assert canvas.shown["/rig/wave_generator"][1][-1] == pytest.approx(2 * np.pi)
    assert canvas.shown["/rig/output"][1][-1] == pytest.approx(-2 * np.pi / 50)
    assert len(canvas.shown["/rig/output"][0]) < 250  # 8 s: no more pictures than are seen
    assert len(material(0.0, 0.0)) == 12


def test_how_much_the_deformation_is_exaggerated_is_said() -> None:
    canvas = Kept()
    Space(ABOUT).draw(0.0, canvas)
    assert "deformation of the flexspline drawn 7 times" in canvas.shown["/rig/words"]  # 4 mm for 30 mm / 50


@pytest.mark.parametrize(
    ("procedure", "title", "first"),
    [
        ("kinematic_error", "kinematic-error", "/folded"),
        ("stiffness_lock", "stiffness-lock", "/wind_up"),
        ("other", "lock-check", "/wind_up"),
        ("friction", "friction", "/stribeck"),
        ("standstill", "standstill", "/curves/error"),
        ("something_new", "something-new", "/folded"),
    ],
)
def test_the_right_plot_stands_first(procedure: str, title: str, first: str) -> None:
    layout = layout_for(procedure, title, None)
    assert panes(layout.root)[0].path == first
    assert {"/page", "/rig", "/events", "/curves/tick"} <= {pane.path for pane in panes(layout.root)}


def test_a_trip_stands_out_in_the_log_and_hostile_words_act_on_nothing() -> None:
    canvas, picture = Kept(), Picture(replace(ABOUT, gear="[x](http://y)\n# big"), 1, None)
    picture.begin(canvas)
    picture.event({"t": 1.0, "kind": "trip", "text": "motor speed 200 rpm"}, canvas)
    picture.event({"t": None, "kind": "note", "text": "x"}, canvas)
    assert canvas.said == ["ERROR trip: motor speed 200 rpm", "INFO note: x"]
    assert "[" not in canvas.shown["/page"]
    assert "\n# big" not in canvas.shown["/page"]


def test_panes_that_would_stay_empty_are_left_out() -> None:
    nothing = absent(ABOUT, lambda curve: curve.startswith("/curves/angle"))
    shown = {pane.path for pane in panes(layout_for("stiffness_lock", "stiffness-lock", None, nothing).root)}
    assert shown == {"/curves/angle", "/page", "/rig", "/curves/tick", "/events"}


def test_what_is_no_straight_spring_is_drawn_beside_the_whole_torque() -> None:
    canvas, drawing = Kept(), Trail(loss(7000.0), 50.0, "")
    twist = np.linspace(-1e-3, 1e-3, 4000)
    drawing.add(block(4000, theta_m=twist * 50, theta_l=0.0, tau_l=twist * 7000 + 2.0), canvas)
    y = np.concatenate([line[:, 1] for path, v in canvas.shown.items() if "/trail/" in path for line in v])
    assert np.ptp(y) < 1e-3  # a constant: the spring is gone


def test_a_fast_turn_of_few_rows_is_seen_and_orders_beyond_its_rows_are_not_shown() -> None:
    canvas, rows = Kept(), turning(12.5, 40.0, order=2, n=12 * 21)
    orders, planes = Orders(50.0), Folded(50.0, "")
    for drawing in (orders, planes):
        drawing.add(rows, canvas)
    at, amplitude = canvas.shown["/orders"]
    assert at[np.argmax(amplitude)] == 2.0
    assert amplitude[at > 6.0].max() == 0.0
    assert canvas.shown["/folded/forward/words"] == ["forward, mean of 11 turns"]


def test_a_turn_of_which_a_third_was_not_seen_is_none() -> None:
    theta = np.linspace(0.0, 3.5, 7000) * 2 * np.pi
    seen = (theta < 2.2 * np.pi) | (theta > 2.9 * np.pi)
    assert [turn.number for turn in Turns().add(theta[seen], np.zeros(seen.sum()))] == [2]


def test_a_turn_in_which_the_motor_came_to_rest_ends_before_the_gear_unwinds() -> None:
    rows = turning(5.5, 40.0)
    rest = block(500, theta_m=rows["theta_m"][-1], tau_l=0.0, age=1e-4)
    unwound = np.radians(300.0 / 3600) * (1 - np.exp(-np.arange(500) / 50))
    rest.rows["theta_l"] = rows["theta_l"][-1] + unwound
    rest.rows["t"] += rows.t[-1] + 1e-3
    canvas, drawing = Kept(), Folded(50.0, "")
    for piece in (rows, rest):
        drawing.add(piece, canvas)
    drawing.over(float(rest.t[-1]), canvas)
    numbers = canvas.shown["/folded/frame/numbers"]
    line = canvas.shown["/folded/now/line"][0]
    angle = np.radians(line[:, 0] / WIDTH * 360.0)
    assert heights(line, numbers) == pytest.approx(40.0 * np.cos(2 * angle), abs=3.0)
    assert math.degrees(angle[-1]) == pytest.approx(180.0 - 20.0, abs=1.5)
    assert canvas.shown["/folded/now/dot"] == pytest.approx(line[-1:])


def test_a_motor_that_came_to_rest_soon_after_a_turn_leaves_no_piece_of_one() -> None:
    canvas, drawing = Kept(), Folded(50.0, "")
    rows = turning(5.03, 40.0)
    drawing.add(rows, canvas)
    assert canvas.shown["/folded/now/line"]
    drawing.over(float(rows.t[-1]), canvas)
    assert canvas.shown["/folded/now/line"] == []
    assert canvas.shown["/folded/now/dot"].shape == (0, 2)
