"""The page: says where the data come from, shows what there is, escapes what it is given, needs nobody else."""

import os
import re
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rig.analysis.findings.result import Check, Estimate, Result, Verdict
from rig.report import page, shell
from rig.report.figures import CATALOGUE
from rig.report.palette import DARK, LIGHT
from tests.report import made_up

pytestmark = pytest.mark.xdist_group("page")  # the full one is drawn once, not once for every worker
VOID = {"meta", "br", "img", "link", "hr", "input"}
SMALL = made_up.curves(revolutions=5, grid=96)
FEW = {name: values for name, values in SMALL.items() if name.startswith("mse.")}
BENCH = {"gear": {"serial": "X", "K": {"value": 7160.0, "unit": "N·m/rad", "from": "paper", "note": "whole path"}}}
HOSTILE = "</style></title><script>alert(1)</script><img src=x onerror=alert(1)>\"'&{{ 7*7 }}"


def render(result: Result | None = None, timing: Any = made_up.TIMING, **changes: Any) -> str:
    found = made_up.result(curves=FEW) if result is None else result
    return page.render(made_up.manifest(**changes), timing, made_up.EVENTS, found, "0147-run-3f9c", BENCH)


class Reader(HTMLParser):
    """Checks that every element is closed in turn; collects text, ids, headings, attributes."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.text: list[str] = []
        self.headings: list[int] = []
        self.attributes: list[tuple[str, str, str]] = []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.attributes += [(tag, name, value or "") for name, value in attrs]
        if tag not in VOID:
            self.open.append(tag)
        if re.fullmatch("h[1-6]", tag):
            self.headings.append(int(tag[1]))

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.attributes += [(tag, name, value or "") for name, value in attrs]

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] != "style":
            self.text.append(data)

    @property
    def words(self) -> str:
        return " ".join(" ".join(self.text).split())

    def ids(self) -> list[str]:
        return [value for _, name, value in self.attributes if name == "id"]


@cache
def full() -> str:
    """A page with everything on it: drawn where it is asked for, not wherever tests are counted."""
    return render(made_up.result(curves=SMALL))


@cache
def read() -> Reader:
    return Reader(full())


@pytest.mark.slow
def test_every_element_is_closed_and_every_id_is_there_once() -> None:
    assert len(read().ids()) == len(set(read().ids()))


@pytest.mark.slow
def test_every_reference_inside_the_page_is_met() -> None:
    wanted = {v[1:] for _, name, v in read().attributes if name == "href"}
    wanted |= {
        i for _, name, v in read().attributes if name in ("aria-labelledby", "aria-describedby") for i in v.split()
    }
    assert wanted <= set(read().ids())


def test_nothing_outside_the_file_is_asked_for() -> None:
    assert not re.search(r"(?:src|href|action|data)\s*=\s*[\"']?\s*(?:https?:|//|file:)", full())
    assert "@import" not in full()
    assert "<script" not in full()
    assert not re.search(r"url\((?!#)", full())
    assert "default-src 'none'" in full()


def test_headings_go_down_one_level_at_a_time() -> None:
    assert read().headings[0] == 1
    assert read().headings.count(1) == 1
    assert all(b <= a + 1 for a, b in zip(read().headings, read().headings[1:], strict=False))


def test_the_verdict_and_the_headline_come_before_everything_else() -> None:
    places = [
        full().index(f'id="{part}"') for part in ("verdict", "figures", "checks", "kinematic-error", "provenance")
    ]
    assert places == sorted(places)
    shown = read().words[read().words.index("Main figures Kinematic error, peak to peak") :]
    assert shown.startswith("Main figures Kinematic error, peak to peak 93.41 ± 0.27 arcsec 1.5568 ± 0.0045 arcmin")


def test_the_definition_of_peak_to_peak_stands_beside_it() -> None:
    assert "transmission accuracy is over one output turn and is not the same" in read().words


def test_a_simulated_run_says_so_on_top_in_the_title_at_the_foot_on_paper_and_on_every_figure() -> None:
    assert "<title>SIMULATED" in full()
    assert "No gear was measured" in full()
    assert '@top-right { content: "SIMULATED"' in full()
    figures = re.findall(r"<svg[^>]*class=\"plot\".*?</svg>", full(), re.DOTALL)
    assert len(figures) == 2 * len(CATALOGUE)
    assert all(">SIMULATED<" in figure for figure in figures)
    assert "MEASURED" not in read().words.replace("No gear was measured", "")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("backend", "word"),
    [
        ("can", "MEASURED"),
        ("serial", "MEASURED"),
        ("imported", "IMPORTED"),
        ("abacus", "ORIGIN UNKNOWN"),
        (None, "ORIGIN UNKNOWN"),
    ],
)
def test_any_other_run_says_where_it_comes_from_and_never_simulated(backend: str | None, word: str) -> None:
    text = render(backend=backend)
    assert f"<strong>{word}</strong>" in text
    assert f"<title>{word}" in text
    assert "SIMULATED" not in text.replace(HOSTILE, "")


@pytest.mark.slow
@pytest.mark.parametrize("verdict", list(Verdict))
def test_every_verdict_has_a_sign_and_a_word(verdict: Verdict) -> None:
    words = Reader(render(made_up.result(verdict=verdict, curves=FEW))).words
    expected = {"PASS": "✓ Verdict: Pass", "FAIL": "✗ Verdict: Fail", "INCONCLUSIVE": "? Verdict: Inconclusive"}
    assert expected.get(verdict, "– Verdict: No limit set") in words


def test_a_check_is_said_to_be_met_or_not_in_words_too() -> None:
    assert "✓ Met: Stuck" in read().words
    assert "✗ Not met: 28 whole" in read().words
    assert "1 of 3 conditions was not met" in read().words


def test_a_run_that_did_not_come_to_its_end_says_so() -> None:
    words = Reader(render(status="tripped", exit_reason="shaft torque 46 N·m, limit 45 N·m")).words
    assert "The run did not come to its own end. Tripped by the guard: shaft torque 46 N·m, limit 45 N·m" in words
    assert "did not come to its own end" not in read().words


def test_on_a_virtual_clock_lateness_is_left_out_and_it_is_said_why() -> None:
    words = Reader(render(timing=made_up.TIMING | {"clock": "virtual"})).words
    assert "lateness has no meaning" in words
    assert "Lateness p50" not in words
    assert "Lateness p50 61 µs Lateness p99 143 µs Lateness p99.9 402 µs Lateness, greatest 2.61 ms" in read().words


def test_provenance_names_the_software_the_commit_and_that_it_was_changed() -> None:
    assert "hdrig 0.1.0, commit a3bae8f3c0ffee, with uncommitted changes" in read().words
    assert "2026-11-20 01:47:12 UTC" in read().words
    assert "9f" * 32 in read().words
    assert "gear.K 7160 N·m/rad paper whole path" in read().words


def test_the_hash_of_what_is_derived_from_the_run_is_not_printed() -> None:
    assert "00" * 32 not in full()


def test_unknown_keys_of_a_manifest_are_shown_and_not_dropped() -> None:
    words = Reader(render(grease={"kind": "SK-1A", "hours": 12.5})).words
    assert "grease.kind SK-1A" in words
    assert "grease.hours 12.5" in words


def test_whatever_a_file_holds_is_text_and_stays_text() -> None:
    result = made_up.result(
        procedure=HOSTILE,
        sentence=HOSTILE,
        estimates=(Estimate(HOSTILE, HOSTILE, 1.0, HOSTILE, (0.0, 2.0), HOSTILE),),
        checks=(Check(HOSTILE, False, HOSTILE),),
        cannot=(HOSTILE,),
        tables={HOSTILE: [{HOSTILE: HOSTILE}]},
        curves={HOSTILE: np.zeros(3)},
    )
    manifest = {
        "schema": HOSTILE,
        "backend": HOSTILE,
        "status": HOSTILE,
        "gear": {"serial": HOSTILE, HOSTILE: HOSTILE},
        "conditions": {HOSTILE: HOSTILE},
        "declared": {HOSTILE: HOSTILE},
        "files": {HOSTILE: {"sha256": HOSTILE}},
        HOSTILE: {HOSTILE: [HOSTILE]},
    }
    bench = {HOSTILE: {"value": HOSTILE, "unit": HOSTILE, "from": HOSTILE, "note": HOSTILE}}
    text = page.render(manifest, {HOSTILE: HOSTILE}, [{HOSTILE: HOSTILE, "kind": HOSTILE}], result, HOSTILE, bench)
    reader = Reader(text)
    assert "<script" not in text
    assert "<img" not in text
    assert not any(name.startswith("on") for _, name, _ in reader.attributes)
    assert text.count("</style>") == 1
    assert "alert(1)" in reader.words
    assert ">49" not in text


def test_a_name_in_the_style_sheet_cannot_leave_its_string() -> None:
    assert shell.css_string('a"b\\c</style>\n') == '"a\\22 b\\5c c\\3c \\2f style\\3e \\a "'


@pytest.mark.slow
@given(st.sets(st.sampled_from(sorted(made_up.manifest()))), st.booleans(), st.booleans(), st.data())
@settings(max_examples=10, deadline=None)
def test_a_folder_made_by_somebody_else_gives_a_page_with_what_there_is(
    kept: set[str], timed: bool, noted: bool, data: st.DataObject
) -> None:
    whole = made_up.result(curves=SMALL)
    names = sorted({n.split(".")[0] for n in whole.curves})
    drawn = data.draw(st.sets(st.sampled_from(names), max_size=2))
    few = made_up.result(
        curves={n: v for n, v in whole.curves.items() if n.split(".")[0] in drawn},
        estimates=whole.estimates[: data.draw(st.integers(0, 2))],
        checks=whole.checks[: data.draw(st.integers(0, 3))],
        cannot=(),
        tables={},
    )
    manifest = {k: v for k, v in made_up.manifest().items() if k in kept}
    text = page.render(manifest, made_up.TIMING if timed else None, made_up.EVENTS if noted else [], few, "run", {})
    reader = Reader(text)
    assert len(reader.ids()) == len(set(reader.ids()))
    assert {v[1:] for _, name, v in reader.attributes if name == "href"} <= set(reader.ids())
    assert ("Loop timing" in reader.words) == timed
    assert "None" not in reader.words


@pytest.mark.slow
def test_the_same_run_gives_the_same_page() -> None:
    assert render(made_up.result(curves=made_up.curves(revolutions=5, grid=96))) == full()


@pytest.mark.slow
def test_the_page_of_a_200_s_run_is_below_one_and_a_half_megabytes() -> None:
    assert len(render(made_up.result()).encode()) < 1_500_000


def test_the_page_is_written_whole_into_the_folder_and_nothing_is_left_beside_it(tmp_path: Path) -> None:
    (tmp_path / "bench.toml").write_text('[gear]\nN = { value = 50.0, unit = "1", from = "paper" }\n')
    path = page.write(tmp_path, made_up.manifest(), None, [], made_up.result(curves=FEW))
    assert path == tmp_path / "report.html"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["bench.toml", "report.html"]
    assert "gear.N" in path.read_text(encoding="utf-8")
    assert tmp_path.name in Reader(path.read_text(encoding="utf-8")).words


def test_a_report_written_elsewhere_reads_the_bench_of_the_run(tmp_path: Path) -> None:
    run, out = tmp_path / "the-run", tmp_path / "out"
    run.mkdir()
    out.mkdir()
    (run / "bench.toml").write_text("[loop]\nrate = 1000.0\n")
    text = page.write(out, made_up.manifest(), None, [], made_up.result(curves=FEW), run=run).read_text(
        encoding="utf-8"
    )
    assert "loop.rate" in text
    assert "the-run" in text


def test_a_bench_file_that_cannot_be_read_does_not_stand_in_the_way(tmp_path: Path) -> None:
    (tmp_path / "bench.toml").write_bytes(b"\xff = [")
    assert page.bench(tmp_path) == {}
    (tmp_path / "bench.toml").unlink(missing_ok=True)
    os.mkfifo(tmp_path / "bench.toml")  # nobody ever writes: it must not be waited for
    assert page.bench(tmp_path) == {}


def test_dark_and_light_have_the_same_colours_by_name_and_no_two_share_a_drawn_one() -> None:
    assert list(LIGHT) == list(DARK)
    assert len(set(LIGHT.values())) == len(LIGHT)


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
def test_text_stands_out_from_the_page_and_lines_can_be_seen(theme: dict[str, str]) -> None:
    for name in ("ink", "muted", "forward", "reverse", "fit", "bar", "level", "mark", "good", "bad", "warn"):
        assert contrast(theme[name], theme["paper"]) >= 4.5, name
    for name in ("axis", "mark", "good", "bad", "warn", "muted"):
        assert contrast(theme[name], theme["paper"]) >= 2.9, name


def contrast(one: str, other: str) -> float:
    """Ratio of relative luminances as WCAG 2 defines it."""
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def luminance(colour: str) -> float:
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
