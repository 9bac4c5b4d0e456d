"""The page of a damaged run: written, whatever the folder holds."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from rig.analysis.findings.result import Check, Verdict
from rig.report.page import render, write
from rig.report.record import write_result
from tests.report.made_up import EVENTS, TIMING, manifest, result


def deep(levels: int = 3000) -> dict[str, Any]:
    tree: dict[str, Any] = {}
    for _ in range(levels):
        tree = {"a": tree, "b": [1]}
    return tree


ODD: tuple[Any, ...] = ("\ud800", ["a", {}], 10**400, float("nan"), {"x": {"y": "\udfff"}}, deep(), None, True, 1e300)
PLAIN = replace(result(), curves={}, tables={})


KEYS = (*manifest(), "label", "loop", "proof", "anything")


def write_with(folder: Path, key: str, value: Any) -> None:
    """A page of a manifest that has `value` there, and deeper down."""
    write(folder, manifest(**{key: value}), TIMING, EVENTS, PLAIN)
    write(folder, manifest(**{key: {"rows": value, "x": {"bytes": value}}}), TIMING, EVENTS, PLAIN)
    assert "</html>" in (folder / "report.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("value", ODD, ids=lambda v: str(type(v).__name__))
def test_a_page_is_written_whatever_the_statistics_and_events_say(tmp_path: Path, value: Any) -> None:
    write(tmp_path, manifest(), value, value, PLAIN)
    write(tmp_path, manifest(), {"period": value, "ticks": value, "lateness_p50": value}, [value, {"t": value}], PLAIN)
    write_result(tmp_path, replace(PLAIN, procedure="\ud800"))
    assert "</html>" in (tmp_path / "report.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("key", KEYS)
def test_a_page_is_written_whatever_a_key_says(tmp_path: Path, key: str) -> None:
    write_with(tmp_path, key, ODD[KEYS.index(key) % len(ODD)])


@pytest.mark.long
@pytest.mark.parametrize("value", ODD, ids=lambda v: str(type(v).__name__))
def test_a_page_is_written_whatever_any_key_says(tmp_path: Path, value: Any) -> None:
    for key in KEYS:
        write_with(tmp_path, key, value)


def page(found: Any = PLAIN, **changes: Any) -> str:
    return render(manifest(**changes), TIMING, EVENTS, found, "run", {})


def test_the_figures_of_a_rejected_run_are_marked_as_not_counting() -> None:
    first, *others = PLAIN.estimates
    sentence = "It hunts; `hdrig tune` finds gains. Figures are shown but do not count: 93 arcsec."
    found = replace(
        PLAIN,
        verdict=Verdict.FAIL,
        sentence=sentence,
        rejected=True,
        estimates=(replace(first, how="Series.", counts=False), *others),
    )
    text = page(found)
    assert text.count("does not count</p>") == 1
    assert 'class="first void"' in text
    assert '<code class="code">hdrig tune</code>' in text
    assert "`" not in text.split("</style>")[1]
    assert "the run is rejected and its figures do not count" in text
    assert "with that in mind" not in text
    assert "does not count</p>" not in page()


def test_a_run_of_no_known_procedure_is_called_by_its_label() -> None:
    other = replace(PLAIN, procedure="other")
    assert "<h1>LARA8 axis 3</h1>" in page(other, label="LARA8 axis 3")
    assert "<h1>Measured motion</h1>" in page(other)


def test_rows_of_the_proof_and_the_loop_show_their_units() -> None:
    proof = {"breakaway": 0.31, "shaft_torque_difference": 0.5, "shaft_torque_error": 0.02, "ratio": 50.0}
    text = page(proof=proof, loop={"rate": 1000.0}).replace("\u00a0", " ")
    assert "0.31 N·m" in text
    assert "0.500 ± 0.040 N·m" in text
    assert "1000 Hz" in text
    assert "shaft_torque_error" not in text


@pytest.mark.parametrize(
    ("failed", "said"),
    [
        (("limit_peak_to_peak",), "1 of 3 conditions was not met, a limit alone: no reason to doubt the figures."),
        (("limit_peak_to_peak", "speed"), "2 of 3 conditions were not met: read the figures with that in mind."),
    ],
)
def test_a_limit_that_is_not_kept_casts_no_doubt_on_the_figures(failed: tuple[str, ...], said: str) -> None:
    names = ("whole_turns", "speed", "limit_peak_to_peak")
    checks = tuple(Check(name, name not in failed, "12 of 13.") for name in names)
    assert said in page(replace(PLAIN, verdict=Verdict.FAIL, checks=checks))
