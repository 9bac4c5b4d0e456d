"""Figures of a trace: drawn from what there is, absent without it, and what they say is what the arrays hold."""

import numpy as np
import pytest

from rig.analysis.tracing.residual.shares import COORDINATES, PAIRS
from rig.report.figures import Frame, svg
from rig.report.figures.canvas import Drawing
from rig.report.trace.channels import CHANNELS
from rig.report.trace.figures import CATALOGUE, before_after, home, style, where
from rig.report.trace.page import drawn
from tests.report.trace import made_up

CURVES = drawn(made_up.explained())
NARROW = Frame(360.0)


def named(drawing: Drawing) -> str:
    return drawing.name


@pytest.mark.parametrize("drawing", CATALOGUE, ids=named)
def test_a_figure_without_its_curves_is_absent(drawing: Drawing) -> None:
    assert svg(drawing, {}, NARROW) is None
    assert isinstance(drawing.say({}), str)


@pytest.mark.slow
@pytest.mark.parametrize("drawing", [d for d in CATALOGUE if d is not before_after.SHAFT_TORQUE], ids=named)
def test_a_figure_of_simulated_runs_says_so(drawing: Drawing) -> None:
    text = svg(drawing, CURVES, Frame(360.0, "SIMULATED"))
    assert text is not None
    assert "SIMULATED" in text
    assert drawing.say(CURVES)


@pytest.mark.slow
@pytest.mark.parametrize("drawing", CATALOGUE, ids=named)
def test_curves_of_nan_do_not_break_a_figure(drawing: Drawing) -> None:
    holes = {name: np.full(np.shape(values), np.nan) for name, values in CURVES.items()}
    svg(drawing, holes, NARROW)


def test_channels_at_their_floor_have_no_close_up() -> None:
    assert svg(before_after.SHAFT_TORQUE, CURVES, NARROW) is None
    assert "close.slow_ke_2.M.turns" in CURVES  # 1.4 times its floor


def test_slow_fast_and_loaded_runs_are_told_by_speed_and_load() -> None:
    found = before_after.chosen(CURVES, CHANNELS[0])
    assert found == {"slow": "slow_ke_2", "fast": "speed_400rpm_2", "loaded": "load_40nm_2"}
    lone = {name: values for name, values in CURVES.items() if "400rpm" not in name and "load_40" not in name}
    assert before_after.chosen(lone, CHANNELS[0]) == {"slow": "slow_ke_2"}


def test_what_predicts_the_residual_is_named_in_the_order_the_tracer_gives() -> None:
    assert len(home.ROWS) == len(COORDINATES) + len(PAIRS)
    assert "motor angle and torque 88 %" in home.DRAWING.say(CURVES)
    assert home.told(CURVES) == [
        "Kinematic error: motor angle and torque predict 88\u00a0% of the excess over the floor."
    ]
    close = CURVES | {"share.A": np.array([0.0, 0.0, 0.0, 0.0, 0.61, 0.0, 0.0, 0.0, 0.0, 0.0, 0.86])}
    assert home.told(close)[0].endswith("; torque, rising or falling: 61\u00a0%.")
    assert [" and ".join(pair).replace("_", " ").replace("load", "torque") for pair in PAIRS] == [*home.ROWS[7:]]


def test_the_motor_torque_is_shown_in_millinewton_metres() -> None:
    assert "RMS 8.5 mN·m off before" in before_after.MOTOR_TORQUE.say(CURVES)  # a fifth of 60 mN·m/√2


@pytest.mark.slow
@pytest.mark.parametrize(("low", "high"), [(0.2, 5.6), (-50.0, 50.0), (60.0, 330.0), (7.0, 420.0)])
def test_a_scale_of_torque_or_speed_has_ticks_to_read_it_by(low: float, high: float) -> None:
    """Torques of a campaign under small loads lie between two decades."""
    curves = dict(CURVES)
    for coordinate in ("load", "speed"):
        curves[f"where.A.{coordinate}.x"] = np.linspace(low, high, len(curves[f"where.A.{coordinate}.x"]))
    figure = where.draw(curves, Frame(760.0))
    assert figure is not None
    for panel in figure.axes:
        if panel.get_xlabel() in ("Torque, N·m", "Speed, rpm"):
            left, right = panel.get_xlim()
            assert sum(left <= tick <= right for tick in panel.get_xticks()) >= 2, (panel.get_xlabel(), left, right)


@pytest.mark.parametrize(("low", "high"), [(-6.0, 3.0), (-150.0, 150.0), (9.0, 310.0), (0.2, 5.6), (-2.0, 0.5)])
def test_numbers_below_a_small_panel_do_not_lie_upon_each_other(low: float, high: float) -> None:
    ticks = where._beyond_the_knee(low, high, 1.0)
    assert len(ticks) >= 2
    places = np.arcsinh(ticks) / (np.arcsinh(high) - np.arcsinh(low))
    assert np.diff(places).min() >= where.APART


def test_long_names_of_runs_are_cut_in_their_middle_and_stay_apart() -> None:
    runs = [f"1121-2310-constant-torque-TWIN-40-50-{tail} (part held out)" for tail in ("662f", "d2b2")]
    called = style.labels(runs, 27)
    assert called == ["1121-2310-constant…-50-662f", "1121-2310-constant…-50-d2b2"]
    assert style.labels(["slow_ke_2"], 27) == ["slow_ke_2"]
    both = ["slow", "slow (part held out)"]  # a run of each name: what tells them apart stays
    assert style.labels(both, 27) == both


def test_a_long_name_in_a_title_leaves_room_for_the_unit() -> None:
    long = "1121-2310-constant-torque-TWIN-40-50-662f (part held out)"
    wide, narrow = (style.titled(long, frame) for frame in (Frame(760.0), NARROW))
    assert wide == "1121-2310-constant-torque-TWIN-40-50-662f"
    assert narrow == "1121-2310-c…-50-662f"
    assert style.titled("load_40nm_2", NARROW) == "load_40nm_2"


def test_one_run_alone_is_called_neither_slow_nor_fast() -> None:
    curves = {k: v for k, v in CURVES.items() if k.split(".")[0] != "close" or "speed_400rpm_2" in k}
    figure = before_after.draw(curves, Frame(760.0), CHANNELS[0])
    assert figure is not None
    titles = [text.get_text() for panel in figure.axes for text in panel.texts]
    assert any(text.startswith("speed_400rpm_2, 404 rpm") for text in titles), titles
    assert not any(text.startswith("Slow") for text in titles)
