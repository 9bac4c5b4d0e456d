"""Held-out runs outside the range of the fitted ones: said with numbers, and nothing is concluded from them alone."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.answer import NextRun, Status, Verdict
from rig.analysis.tracing.outcome.beyond import Beyond, beyond, undecided
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.selection.conclusion import Conclusion
from rig.analysis.tracing.trace import trace
from rig.model.effect import Parameter, parameter
from tests.analysis.tracing.test_few_channels import reduced

RUNS = ("slow_ke_1", "slow_ke_2", "load_10nm_1", "load_10nm_2", "speed_120rpm_1", "speed_300rpm_1", "lock_60_1")


def run(rpm: float, torque: float = 5.0, locked: bool = False) -> Any:
    piece = SimpleNamespace(torque=np.linspace(-torque, torque, 101))
    return SimpleNamespace(
        name=f"at-{rpm:g}", turning=rpm * np.pi / 30, locked=locked, pieces=(piece,), has=frozenset({"tau_l"})
    )


def prepared(fitted: list[Any], held: list[Any], loud: set[int] = frozenset()) -> Any:  # type: ignore[assignment]
    """As much of a trace as is asked: runs, and held-out blocks of which the runs `loud` are too loud."""
    n = len(fitted)
    held_out = SimpleNamespace(
        runs=tuple(range(n, n + len(held))),
        loud=lambda e, one: any(i in loud for i, _ in e),
        worst=lambda e: (27.5, 30.0),
    )
    split = SimpleNamespace(fitted=tuple(range(n)))
    return SimpleNamespace(eq=SimpleNamespace(runs=(*fitted, *held)), split=split, held_out=held_out)


def found(p: Any, *baseline: Parameter) -> Beyond:
    out = beyond(p, baseline)
    assert out is not None
    return out


def test_runs_within_the_range_or_a_little_beyond_are_not_outside() -> None:
    fitted = [run(10.0), run(300.0), run(0.0, 60.0, locked=True)]
    assert beyond(prepared(fitted, [run(120.0), run(380.0), run(8.0), run(0.0, 70.0, locked=True)]), ()) is None


@pytest.mark.parametrize("held", [run(400.0), run(5.0), run(120.0, 90.0), run(0.0, 90.0, locked=True)])
def test_faster_slower_or_more_loaded_ones_are(held: Any) -> None:
    fitted = [run(10.0), run(300.0), run(0.0, 60.0, locked=True)]
    assert found(prepared(fitted, [run(120.0), held])).outside == (4,)


def test_a_long_list_of_runs_says_how_many_more_there_are_and_where_they_stand() -> None:
    fitted = [run(float(rpm)) for rpm in range(10, 60, 10)]
    said = found(prepared(fitted, [run(400.0)])).sentence()
    assert "1 of 1 held-out runs (at-400) lies" in said
    assert "5 fitted runs (at-10, at-20, at-30 and 2 more)" in said
    assert "All runs stand in the report's list of runs and under `runs` in trace.json" in said
    few = found(prepared(fitted[:2], [run(400.0)])).sentence()
    assert "more" not in few
    assert "trace.json" not in few


def test_where_no_fitted_run_turns_freely_every_one_that_does_is_outside() -> None:
    said = found(prepared([run(0.0, 60.0, locked=True)], [run(120.0)])).sentence()
    assert "(mean motor speed none fitted, 120 rpm there)" in said


def test_the_sentence_names_runs_numbers_and_what_they_do_not_determine() -> None:
    p = prepared([run(10.0), run(11.0)], [run(120.0), run(400.0)])
    drag, stiff = parameter("B_l", -2.32, 1.0, "N·m·s/rad"), parameter("K", 7000.0, 10.0, "N·m/rad")
    damping = parameter("B_sp", 1.0, 2.0, "N·m·s/rad")  # of either sign, for filters lag
    said = found(p, drag, stiff, damping).sentence()
    assert said == (
        "2 of 2 held-out runs (at-120, at-400) lie outside what the 2 fitted runs (at-10, at-11) cover (mean motor "
        "speed 10 to 11 rpm fitted, 120 to 400 rpm there), and the fitted runs do not determine B_l (-2.32 "
        "N·m·s/rad, 95 % -3.32 to -1.32), which no gear has below zero."
    )


def test_of_a_torque_beyond_the_sentence_says_the_torque_of_the_run_it_names() -> None:
    p = prepared([run(10.0), run(300.0)], [run(390.0, 4.0), run(0.0, 50.0, locked=True)])
    said = found(p).sentence()
    assert "1 of 2 held-out runs (at-0) lies outside" in said
    assert "(shaft torque, but for a hundredth at each end, -4.9 to 4.9 N·m fitted, -49 to 49 N·m there)" in said
    assert "rpm" not in said


UNKNOWN = Conclusion(
    Verdict(Status.UNKNOWN, (), (), "load", None, None, "What is left lives in load."),
    Home("load", "M", 1.77),
    ("load",),
    NextRun("stiffness_lock", {}, "shows more"),
)
AFTER: Any = {(1, "M"): np.ones(3), (2, "M"): np.ones(3)}


def test_what_stands_outside_alone_decides_nothing() -> None:
    p = prepared([run(10.0)], [run(10.0), run(400.0)], loud={2})
    conclusion, decided = undecided(p, UNKNOWN, AFTER, found(p))
    assert not decided
    assert conclusion.verdict.status is Status.AMBIGUOUS
    assert conclusion.verdict.sentence.startswith(
        "Not decided: the held-out runs are 27.5 times the floor off, but 1 of 2"
    )
    assert (conclusion.home, conclusion.next_run, conclusion.lives_in) == (None, None, ())


def test_what_stands_inside_too_is_left_and_the_range_is_a_word_beside_it() -> None:
    p = prepared([run(10.0)], [run(10.0), run(400.0)], loud={1, 2})
    conclusion, decided = undecided(p, UNKNOWN, AFTER, found(p))
    assert decided
    assert conclusion.verdict == UNKNOWN.verdict
    assert conclusion.cannot == (found(p).sentence(),)
    assert undecided(p, UNKNOWN, AFTER, None) == (UNKNOWN, True)


@pytest.mark.long
def test_a_clean_campaign_asked_for_speeds_it_was_not_fitted_at_is_no_unknown_effect(
    tmp_path: Path, shared: Path
) -> None:
    folder = reduced(tmp_path, shared / "cases" / "open-1", RUNS, ())
    made = trace(folder, ["speed_*", "lock*"])
    assert made.verdict.status is Status.AMBIGUOUS
    assert "3 of 3 held-out runs (" in made.verdict.sentence
    assert "lie outside what the 4 fitted runs" in made.verdict.sentence
    assert (made.added_curves, made.law) == ((), ())
    assert made.ratios_after == made.ratios_before
