"""The page of the paper's figures: signs, origin, what is missing, and nothing that is not ours."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from rig.analysis.reproduction.claim import Claim, Number, Ruling, missing
from rig.analysis.reproduction.exhibit import Exhibit
from rig.report.reproduction import About, told, write
from rig.report.reproduction.page import DRAWINGS, symbols
from rig.report.reproduction.text import found

THETA = (np.arange(512) + 0.5) / 512 * 360.0
TURN = {
    "turn.theta_deg": THETA,
    "turn.measured": np.cos(np.radians(2 * THETA)),
    "turn.model": np.cos(np.radians(THETA)),
}
SIZE = Number.of(93.4, 0.2, "arcsec")
HELD = Claim("it falls", Ruling.HOLDS, "Peak to peak {}.", (SIZE,), "Above zero.")
BROKEN = Claim("it is flat", Ruling.FAILS, "It rises by {}.", (SIZE,), "At most zero.")
DRAWN = Exhibit("Figure 7 a", "θ̃ at 310 rpm", "It is coloured.", "run <1>", (HELD, BROKEN), "compared", TURN)
ABSENT = Exhibit(
    "Figure 9", "Against load", "It falls.", "", (missing("it falls", "No run."),), missing="It takes runs."
)
TABLE = Exhibit("Table 1", "Parameters", "", "", (), columns=("n", "C_n"), rows=(("1", SIZE), ("J_m", 0.0011)))
LOADS = {f"load.{name}": np.array([0.0, 7.5, 0.0, 7.5]) for name in ("load", "value", "low", "high")}


def page(folder: Path, backend: str | None = "sim", *exhibits: Exhibit) -> str:
    about = About(["gear <A>"], ["run 7: stuck"], backend)
    return write(folder, exhibits or (DRAWN, ABSENT, TABLE), about).read_text()


def test_simulated_data_say_so_in_the_band_and_across_every_drawing(tmp_path: Path) -> None:
    text = page(tmp_path)
    assert text.count("<svg") == 2
    drawings = re.findall(r"<svg.*?</svg>", text, re.DOTALL)
    assert all(">SIMULATED<" in drawing for drawing in drawings)
    assert 'class="band mark"' in text


def test_measured_data_do_not(tmp_path: Path) -> None:
    assert "SIMULATED" not in page(tmp_path, "can")


@pytest.mark.slow
def test_every_claim_has_its_sign_and_the_totals_count_them(tmp_path: Path) -> None:
    text = page(tmp_path)
    totals = re.findall(r"<strong>(\d+)</strong>", text)
    assert totals == ["1", "1", "1"]
    assert [re.sub("<.*?>", "", s) for s in re.findall(r'<li class="\w+"><span class="sign".*?</span>', text)] == [
        "✓",
        "✗",
        "–",
    ]


def test_what_is_missing_is_said_where_the_figure_would_be(tmp_path: Path) -> None:
    assert "Not in this campaign.</strong> It takes runs." in page(tmp_path)


def test_runs_that_do_not_count_are_named(tmp_path: Path) -> None:
    assert "run 7: stuck" in page(tmp_path)


def test_names_of_runs_and_gears_are_escaped(tmp_path: Path) -> None:
    text = page(tmp_path)
    assert "run &lt;1&gt;" in text
    assert "gear &lt;A&gt;" in text


def test_the_page_asks_for_nothing_from_outside(tmp_path: Path) -> None:
    text = page(tmp_path)
    assert not re.search(r'(?:src|href)="(?!#)', text)
    assert "<script" not in text


@pytest.mark.slow
def test_the_same_data_give_the_same_page(tmp_path: Path) -> None:
    assert page(tmp_path) == page(tmp_path)


def test_the_numbers_behind_the_page_are_beside_it(tmp_path: Path) -> None:
    page(tmp_path)
    data = json.loads((tmp_path / "reproduction.json").read_text())
    claim = data[0]["claims"][0]
    assert claim["ruling"] == "holds"
    assert claim["numbers"] == [{"value": 93.4, "low": 93.2, "high": pytest.approx(93.6), "unit": "arcsec"}]


def test_the_terminal_gets_one_line_a_claim_and_a_sum() -> None:
    lines = list(told((DRAWN, ABSENT)))
    assert "  ✓ it falls: Peak to peak 93.40 ± 0.20\u00a0arcsec." in lines
    assert lines[-1] == "of 3 claims of the paper 1 hold by these runs, 1 fail, 1 cannot be told"


def test_a_number_without_an_interval_stands_alone() -> None:
    nan = float("nan")
    claim = Claim("K", Ruling.OPEN, "{}", (Number(7160.0, nan, nan, "N·m/rad"),))
    assert found(claim) == "7160\u00a0N·m/rad"


def test_symbols_get_their_subscripts_and_names_of_runs_do_not() -> None:
    assert symbols("θ̃_p and B_sp") == "θ̃<sub>p</sub> and B<sub>sp</sub>"
    assert symbols("run load_10nm_1 of speed_forward") == "run load_10nm_1 of speed_forward"


def test_every_drawing_takes_what_its_figure_gives() -> None:
    assert {"turns", "compared", "spectrum-cpm", "loads", "convergence", "lock"} <= set(DRAWINGS)


def test_loads_are_drawn_by_depth_and_assembly(tmp_path: Path) -> None:
    curves = LOADS | {"load.depth_mm": np.array([0.0, 0.0, 0.3, 0.3]), "load.assembly": np.array([1.0, 1.0, 2.0, 2.0])}
    text = page(tmp_path, "sim", Exhibit("Figure 10", "By depth", "", "", (), "loads", curves))
    assert "reference depth" in text
    assert "+0.3 mm" in text
