"""Figures over any subset of curves: drawn or absent, never empty, never in the way of the page."""

import os
import re
import signal
import xml.etree.ElementTree as ET
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rig.report import figures
from rig.report.figures import CATALOGUE, Drawing, Frame
from rig.report.figures.canvas import Curves
from rig.report.palette import LIGHT
from tests.report import made_up

CURVES = made_up.curves()
SMALL = made_up.curves(revolutions=5, grid=96)
NAMES = sorted(CURVES)
BY_NAME = {d.name: d for d in CATALOGUE}
SVG = "{http://www.w3.org/2000/svg}"
FAMILY = {
    "kinematic-error": "ke.",
    "orders": "orders.",
    "spectrum": "spectrum.",
    "convergence": "mse.",
    "direction": "ke.",
    "torsion": "torsion.",
    "lock": "lock.",
    "local-stiffness": "tangent.",
    "loop-rate": "loop.",
    "creep": "creep.",
    "decomposition": "decomposition.",
    "decomposition-orders": "decomposition.",
    "full-turn": "turn.",
    "full-turn-lines": "turn.",
    "speed-convergence": "convergence.",
    "coast-down": "coast.",
    "friction": "friction.",
    "loads": ("load.", "band."),
    "time": "time.",
}
every_figure = pytest.mark.parametrize("drawing", CATALOGUE, ids=lambda d: d.name)


def spoilt(kind: str, values: made_up.Array) -> made_up.Array | None:
    """A curve as it should not be."""
    turn = np.arange(values.size).reshape(values.shape)
    match kind:
        case "absent":
            return None
        case "empty":
            return np.array([])
        case "nan":
            return np.full_like(values, np.nan)
        case "holes":
            return np.where(turn % 7 == 3, np.nan, values)
        case "infinite":
            return np.where(turn % 5 == 2, np.inf, values)
        case "zero":
            return np.zeros_like(values)
        case "negative":
            return -np.abs(values)
        case "short":
            return values[..., :-1]
        case "single":
            return values[..., :1]
        case "huge":
            return values * 1e12
        case "tiny":
            return values * 1e-12
    return values


KINDS = [
    "as it is",
    "absent",
    "empty",
    "nan",
    "holes",
    "infinite",
    "zero",
    "negative",
    "short",
    "single",
    "huge",
    "tiny",
]


@pytest.mark.slow
@every_figure
@given(st.data())
@settings(max_examples=4, deadline=None)
def test_any_figure_is_drawn_or_absent_whatever_curves_there_are(drawing: Drawing, data: st.DataObject) -> None:
    own = [n for n in NAMES if n.startswith(FAMILY[drawing.name])]
    kinds = data.draw(st.fixed_dictionaries({n: st.sampled_from(KINDS) for n in own}))
    made = {n: spoilt(kind, SMALL[n]) for n, kind in kinds.items()}
    curves = {n: v for n, v in made.items() if v is not None}
    text = figures.svg(drawing, curves, Frame(data.draw(st.sampled_from([360.0, 760.0]))))
    if text is not None:
        assert any(e.tag == f"{SVG}path" for e in ET.fromstring(text).iter())
        assert "nan" not in re.sub(r'aria-label="[^"]*"', "", text)


@cache
def plain(drawing: Drawing) -> str:
    """Drawn where it is asked for, not wherever tests are counted."""
    return str(figures.svg(drawing, CURVES))


@every_figure
def test_a_figure_without_curves_is_absent(drawing: Drawing) -> None:
    assert figures.svg(drawing, {}) is None
    assert figures.png(drawing, {}) is None


@every_figure
def test_a_figure_says_in_words_what_it_shows(drawing: Drawing) -> None:
    root = ET.fromstring(plain(drawing))
    assert root.get("role") == "img"
    assert len(root.get("aria-label", "")) > 30


@pytest.mark.slow
@every_figure
def test_a_figure_drawn_twice_is_the_same(drawing: Drawing) -> None:
    assert figures.svg(drawing, made_up.curves()) == plain(drawing)
    assert figures.png(drawing, CURVES) == figures.png(drawing, made_up.curves())


@pytest.mark.slow
@every_figure
def test_the_word_stands_across_a_marked_figure_and_not_across_another(drawing: Drawing) -> None:
    marked = ET.fromstring(str(figures.svg(drawing, CURVES, Frame(mark="SIMULATED"))))
    assert "SIMULATED" in [e.text for e in marked.iter(f"{SVG}text")]
    assert "SIMULATED" not in plain(drawing)


@pytest.mark.slow
@every_figure
def test_on_a_page_every_colour_is_a_variable_and_text_is_text(drawing: Drawing) -> None:
    text = str(figures.svg(drawing, CURVES, prefix="here-"))
    assert not re.search(r"#[0-9a-fA-F]{6}", text)
    assert set(re.findall(r"var\(--([a-z-]+)\)", text)) <= set(LIGHT)
    root = ET.fromstring(text)
    assert any(e.text for e in root.iter(f"{SVG}text"))
    assert "font-family" not in text
    assert "width" not in root.attrib


@pytest.mark.slow
@every_figure
def test_ids_begin_with_the_prefix_and_every_reference_is_met(drawing: Drawing) -> None:
    text = str(figures.svg(drawing, CURVES, prefix="here-"))
    ids = re.findall(r'\bid="([^"]+)"', text)
    assert len(ids) == len(set(ids))
    assert all(i.startswith("here-") for i in ids)
    assert set(re.findall(r'(?:href="#|url\(#)([^")]+)', text)) <= set(ids)


@pytest.mark.slow
@every_figure
def test_a_figure_of_its_own_carries_its_size_fonts_and_light_colours(drawing: Drawing) -> None:
    root = ET.fromstring(plain(drawing))
    assert root.get("width") == "760"
    assert "sans-serif" in root.get("font-family", "")
    assert "var(" not in plain(drawing)
    png = figures.png(drawing, CURVES)
    assert png is not None
    assert png.startswith(b"\x89PNG")


def test_a_run_in_one_direction_has_no_direction_split_and_still_a_kinematic_error() -> None:
    one = {k: v for k, v in CURVES.items() if "reverse" not in k and k != "ke.direction"}
    assert figures.svg(BY_NAME["direction"], one) is None
    text = figures.svg(BY_NAME["kinematic-error"], one)
    assert text is not None
    assert "mean, forward" in text
    assert "reverse" not in text


def test_an_order_whose_interval_reaches_zero_is_not_told_from_it() -> None:
    low, high = np.ones(15) * 0.1, CURVES["orders.amplitude"] * 2
    low[14] = 0.0
    text = figures.svg(BY_NAME["orders"], CURVES | {"orders.low": low, "orders.high": high})
    assert "not told from zero" in str(text)
    assert "not told from zero" not in plain(BY_NAME["orders"])


@pytest.mark.slow
def test_many_revolutions_are_thinned_and_it_is_said() -> None:
    many = CURVES | {"ke.revolutions_forward": np.tile(CURVES["ke.revolutions_forward"], (10, 1))}
    text = str(figures.svg(BY_NAME["kinematic-error"], many))
    assert "40 of 280 turns forward" in text


def test_the_dimension_line_carries_the_figure_of_the_result() -> None:
    text = str(figures.svg(BY_NAME["kinematic-error"], CURVES | {"ke.peak_to_peak": np.array([91.23, 89.9, 92.6])}))
    assert ">91.2<" in text


def test_an_envelope_keeps_every_peak() -> None:
    from rig.report.figures.arrays import columns

    rng = np.random.default_rng(3)
    low, high = -rng.random(5001), rng.random(5001)
    _, least, greatest = columns(np.arange(5001.0), low, high, 640)
    assert len(least) == 640
    assert (least.min(), greatest.max()) == (low.min(), high.max())


def test_a_run_at_speed_is_not_called_the_kinematic_error() -> None:
    from rig.report.figures import kinematic_error

    slow, fast = made_up.curves(), {**made_up.curves(), "ke.at_speed": np.array([120.0])}
    assert kinematic_error.named(slow)[0].startswith("Kinematic error over")
    title, note = kinematic_error.named(fast)
    assert title.startswith("θ̃ at 120 rpm over")
    assert "fitted series, not of the drawn mean" in note
    text = figures.svg(kinematic_error.DRAWING, fast) or ""
    assert "θ̃ at 120 rpm" in text
    assert "Kinematic error" not in text


def test_an_interrupt_waits_for_the_figure() -> None:
    """In the middle of a path matplotlib made a ValueError of it: --json told of an internal error and 70."""
    done = []

    def pressed(curves: Curves, frame: Frame) -> None:
        os.kill(os.getpid(), signal.SIGINT)
        signal.sigtimedwait({signal.SIGUSR1}, 0.05)
        done.append(True)

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        for make in (figures.svg, figures.png):
            with pytest.raises(KeyboardInterrupt):
                make(replace(CATALOGUE[0], draw=pressed), {})
    finally:
        signal.signal(signal.SIGINT, before)
    assert done == [True, True]
