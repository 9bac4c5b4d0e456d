"""Pages of the catalogue: self-contained, SIMULATED where anything is, the changes in them those of the data."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from rig.catalogue import compare, trend
from rig.report.comparison import course, page, trend_page
from rig.report.comparison.waveforms import drawing, joined
from rig.report.figures import Frame, svg
from tests.catalogue.folders import run

DAYS = ["2026-11-16", "2026-11-17"]


def test_a_comparison_without_samples_has_its_table_and_says_why_there_is_no_waveform(tmp_path: Path) -> None:
    first = [run(tmp_path, DAYS[0], k, 90.0 + 0.1 * (k % 3)) for k in range(6)]
    other = run(tmp_path, DAYS[1], 0, 95.0)
    text = page.render(compare([first[0], other]))
    assert "+5.00 ± 0.42" in text
    assert re.search(r'<td class="changed">95\.00 ± 0\.30', text)
    assert "Waveform of" in text
    assert "SIMULATED" not in text


def test_pages_load_nothing_and_escape_what_manifests_say(tmp_path: Path) -> None:
    bad = "<script>alert(1)</script>"
    a = run(tmp_path, DAYS[0], backend="sim", gear={"serial": bad})
    b = run(tmp_path, DAYS[1], backend="sim", gear={"serial": bad})
    for text in (page.render(compare([a, b])), trend_page.render(trend(tmp_path, "peak-to-peak"))):
        assert bad not in text
        assert "&lt;script&gt;" in text
        assert not re.search(r'(src|href)="(?!#)', text)
        assert "SIMULATED" in text


def test_a_trend_is_drawn_for_each_series_with_its_sentence(tmp_path: Path) -> None:
    for k in range(5):
        run(tmp_path, DAYS[0], k, 90.0 + 0.1 * (k % 3))
    run(tmp_path, DAYS[1], 0, 95.0)
    text = trend_page.render(trend(tmp_path, "peak-to-peak"))
    assert "1 change larger than reproducibility: 2026-11-17 by +4.92 arcsec" in text
    assert text.count("<svg") == 1 + 2, "the sign, and each series for a wide and a narrow page"


def test_waveforms_are_drawn_of_errors_or_of_loops_and_never_of_nothing() -> None:
    theta = np.linspace(0.5, 359.5, 360)
    error = {"ke.theta_deg": theta, "ke.pure": 40 * np.sin(np.radians(2 * theta))}
    loop = {"lock.windup": np.linspace(-3, 3, 5000), "lock.torque": np.linspace(-12, 12, 5000)}
    shown = drawing([1, 2])
    assert "run 2" in str(svg(shown, joined([error, error]), Frame()))
    assert "Shaft torque" in str(svg(shown, joined([loop, loop]), Frame()))
    assert svg(shown, joined([None, None]), Frame()) is None
    assert "span of each: run 1 79.99, run 2 79.99" in shown.say(joined([error, error]))


def test_runs_are_seen_beside_a_band_that_few_repeats_make_very_wide(tmp_path: Path) -> None:
    for k, value in enumerate((90.0, 91.0)):
        run(tmp_path, DAYS[0], k, value)
    (series,) = trend(tmp_path, "peak-to-peak").series
    curves = course.curves_of(series)
    assert np.nanmax(curves["limit"]) > 20.0  # arcsec
    figure = course.drawing(series).draw(curves, Frame(760.0))
    assert figure is not None
    low, high = figure.axes[0].get_ylim()
    assert high - low < 10.0
    assert low < 89.7
    assert high > 91.3
    assert [figure.axes[0].xaxis.get_major_formatter()(k) for k in figure.axes[0].get_xticks()] == [DAYS[0]] * 2


def test_one_run_alone_has_its_date_below_it(tmp_path: Path) -> None:
    run(tmp_path, DAYS[0], 0, 90.0)
    (series,) = trend(tmp_path, "peak-to-peak").series
    figure = course.drawing(series).draw(course.curves_of(series), Frame(760.0))
    assert figure is not None
    assert list(figure.axes[0].get_xticks()) == [1]


def test_undated_runs_are_said_to_lie_in_the_order_of_their_names(tmp_path: Path) -> None:
    for k in range(5):
        run(tmp_path, DAYS[0], k, 90.0 + 0.1 * (k % 3), started_utc=None)
    again = {"speed_rpm": 9.6, "tau_ext": 0.0, "assembly": 2}
    run(tmp_path, DAYS[1], 6, 95.0, started_utc=None, conditions=again)
    text = trend_page.render(trend(tmp_path, "peak-to-peak"))
    assert "in order of time" not in text
    assert "in the order of their names, for they are undated" in text
    assert "Runs in the order of their names" in text
    assert "run 1</text>" in text
    assert "larger than reproducibility: 0006-kinematic-error-2 by +4.92 arcsec" in text
    run(tmp_path, DAYS[1], 7, 95.0)
    assert "undated ones before the others" in trend_page.render(trend(tmp_path, "peak-to-peak"))


def test_the_values_of_a_large_figure_stand_whole_at_the_axis(tmp_path: Path) -> None:
    for k in range(3):
        run(tmp_path, DAYS[0], k, 12100.0 + 0.01 * k, half=0.01)
    (series,) = trend(tmp_path, "peak-to-peak").series
    drawn = str(svg(course.drawing(series), course.curves_of(series), Frame(760.0)))
    assert "12100.03" in drawn
    assert "+1.21" not in drawn
