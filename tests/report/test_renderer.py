"""Our renderer draws what matplotlib's own draws, with shorter paths and without its groups."""

from __future__ import annotations

import io
import re
import xml.etree.ElementTree as ET
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.path import Path
from matplotlib.textpath import text_to_path

from rig.report.figures.canvas import STYLE
from rig.report.figures.paths import steps
from rig.report.figures.renderer import drawn, measured
from tests.report import made_up

HALF = 0.0501  # px: half a tenth
NAMED = re.compile(r"#(m|p|C\d+_\d+_)[0-9a-f]{10}")  # ids are made of paths, and those differ


def figure() -> Figure:
    """What pages have: gaps, a line that leaves the panel, marks, a filled and closed area, curves, words that turn."""
    t = np.linspace(0.0, 4.0, 700)
    noisy = np.sin(5.0 * t) + np.random.default_rng(1).normal(0.0, 0.1, t.size)
    made = Figure(figsize=(5, 3), dpi=72)
    panel: Any = made.add_axes((0.1, 0.1, 0.8, 0.8))
    panel.plot(t, np.where(np.abs(t - 2.0) < 0.3, np.nan, noisy), label="noisy & cut")
    panel.plot(t, 30.0 * t - 40.0, "o-", markevery=90, label="beyond")
    panel.plot(t[::100], noisy[::100], "s")
    panel.scatter(t[::50], -noisy[::50])
    panel.fill_between(t, noisy - 0.2, noisy + 0.2)
    panel.add_collection(LineCollection([np.column_stack((t, noisy + k)) for k in range(3)]))
    panel.text(1.0, 0.5, "turned", rotation=30.0)
    panel.set_ylim(-2.0, 2.0)
    panel.legend()
    return made


def elements(text: str) -> list[ET.Element]:
    """All that is seen, in order, and what it is made from."""
    return [e for e in ET.fromstring(text).iter() if e.tag.rpartition("}")[2] in ("path", "use", "text", "rect")]


def theirs() -> str:
    text = io.StringIO()
    figure().savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    return text.getvalue()


def told(element: ET.Element) -> dict[str, str]:
    """All that is said of an element but its path and its own name."""
    return {key: NAMED.sub(r"#\1", value) for key, value in element.attrib.items() if key not in ("d", "id")}


@pytest.mark.slow
def test_everything_is_drawn_where_matplotlib_draws_it() -> None:
    with mpl.rc_context(STYLE):
        mine, usual = elements(drawn(figure())), elements(theirs())
    assert len(mine) == len(usual) > 60
    for here, there in zip(mine, usual, strict=True):
        assert (here.tag, here.text or "", told(here)) == (there.tag, (there.text or "").strip(), told(there))
        path, whole = here.get("d", ""), there.get("d", "")
        if "C" in whole or "Q" in whole:
            assert path == whole
        elif whole:
            points = np.array(re.findall(r"(-?[\d.]+) (-?[\d.]+)", whole), dtype=float)
            assert farthest(points, walk(path)) < 2 * HALF
            assert farthest(walk(path), points) < 2 * HALF
    assert sum("C" in e.get("d", "") for e in usual) > 1
    assert len(drawn(figure())) < 0.6 * len(theirs())


def farthest(some: made_up.Array, others: made_up.Array) -> float:
    """How far the loneliest of some points (n, 2) is from the nearest of the others [px]."""
    apart = np.abs(some[:, None] - others[None]).max(axis=2)
    return float(apart.min(axis=1).max())


@pytest.mark.slow
def test_a_word_is_laid_out_once_for_all_figures() -> None:
    measured.cache_clear()
    drawn(figure())
    first = measured.cache_info()
    drawn(figure())
    again = measured.cache_info()
    assert first.misses == again.misses > 5
    assert again.hits > first.hits
    font = FontProperties(size=11.0)
    assert measured("0.25 mm", font) == text_to_path.get_text_width_height_descent("0.25 mm", font, False)
    assert measured("0.25 mm", FontProperties(size=22.0))[0] == 2.0 * measured("0.25 mm", font)[0]


def test_a_path_as_steps_leads_to_the_same_points() -> None:
    rng = np.random.default_rng(1)
    points = np.cumsum(rng.normal(0, 3, (200, 2)), axis=0)
    more = [(0.0, 0.0), (3.0, 4.0), (5.0, 6.0), (1.0, 1.0), (2.0, 2.0)]
    codes = [1, *[2] * 199, Path.CLOSEPOLY, 1, 2, 1, 2]
    expected: list[Any] = [*points, points[0], *more[1:]]
    assert np.allclose(walk(steps(np.array([*points, *more]), np.array(codes))), expected, atol=HALF)


def test_a_path_of_nothing_is_no_path() -> None:
    assert steps(np.empty((0, 2)), np.empty(0)) == ""


def test_what_rounding_left_decides_no_tenth() -> None:
    codes = np.array([Path.MOVETO, Path.LINETO])
    sides = [steps(np.array([[0.0, 0.0], [1.05 + noise, 0.0]]), codes) for noise in (-1e-9, 0.0, 1e-9)]
    assert len(set(sides)) == 1


def walk(path: str) -> made_up.Array:
    """Every point of a path of m, l and z."""
    here = start = np.zeros(2)
    out, command = [], ""
    tokens = re.findall(r"[mlz]|-?(?:\d+\.?\d*|\.\d+)", path)
    i = 0
    while i < len(tokens):
        if tokens[i] in "mlz":
            command, i = tokens[i], i + 1
            if command == "z":
                here = start
                out.append(here)
                continue
        here = here + np.array([float(tokens[i]), float(tokens[i + 1])])
        i += 2
        out.append(here)
        if command == "m":
            start, command = here, "l"
    return np.array(out)


def test_what_no_font_has_is_drawn_as_a_blank(recwarn: pytest.WarningsRecorder) -> None:
    made = Figure(figsize=(3, 2), dpi=72)
    made.add_axes((0.1, 0.1, 0.8, 0.8)).set_title("a\trun\x07")
    text = drawn(made)
    assert "\t" not in text.split("a")[-1]
    assert not [w for w in recwarn if "Glyph" in str(w.message)]
