"""The page of a loop: what was advised, what was run, what changed, before and after as a table and a picture."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from rig.analysis.tracing.answer import NextRun, Status
from rig.closing.story import End, Story, told_by
from rig.report.closing.changes import changes, sizes
from rig.report.closing.page import render
from rig.report.closing.rounds import curves, say
from tests.closing.test_left import found

POOLED = {"kinematic_error_rms_arcsec": 4.0, "floor_kinematic_error_arcsec": 1.0}
ASKED = NextRun("constant_torque", {"speed_rpm": 400.0}, "a real angle error makes torque when it turns fast")


def round(number: int, status: Status, after: dict[str, float], asked: NextRun | None = None, **more: Any) -> Any:
    made = asdict(told_by(found(status, after, asked=asked), number, ("standstill",), 4.0 * number))
    return made | {"pooled_before": POOLED, "pooled_after": POOLED | {"kinematic_error_rms_arcsec": 1.1}} | more


def rounds() -> list[Any]:
    drag = {"quadratic_drag": {"D_2": {"value": 3e-6, "ci95": (2e-6, 4e-6), "unit": "N·m·s²/rad²"}}}
    first = round(1, Status.AMBIGUOUS, {"theta_l": 4.0, "tau_m": 1.2}, ASKED, words="constant-torque 400 rpm, twice")
    last = round(2, Status.EXPLAINED, {"theta_l": 1.1, "tau_m": 1.2}, effects=("quadratic_drag",), parameters=drag)
    return [first, last]


def page(made: list[Any]) -> str:
    story = Story("c", True, 60.0, End.EXPLAINED, "It is drag.")
    return render(asdict(story) | {"rounds": made, "end": str(story.end)})


def test_the_page_tells_what_was_advised_run_and_changed() -> None:
    text = page(rounds())
    for said in (
        "Constant torque at motor speed 400\xa0rpm: a real angle error makes torque",
        "constant-torque 400 rpm, twice",
        "The verdict went from ambiguous to explained.",
        "Named now: quadratic drag.",
        "The kinematic error left went from 4.00 to 1.10 times its floor",
        "Quadratic drag: D_2",
        "9.00 → 1.10",
        'href="report.html"',
        "<svg",
    ):
        assert said in text
    assert "motor torque left went" not in text


def test_one_round_has_its_picture_too() -> None:
    assert 'id="rounds"' in page(rounds()[:1])


def test_a_loop_that_ended_before_its_first_trace_has_a_page() -> None:
    text = page([])
    assert "<svg" in text  # the brand alone
    assert 'id="course"' not in text


def test_rounds_alike_are_said_to_be() -> None:
    one, other = round(1, Status.UNKNOWN, {"tau_m": 2.0}), round(2, Status.UNKNOWN, {"tau_m": 2.05})
    assert changes(one, other) == ["Nothing changed but the number of runs."]


def test_an_effect_that_is_dropped_is_said_and_new_sizes_have_no_old_ones() -> None:
    first, last = rounds()
    assert "Named no more: quadratic drag." in changes(last, first)
    ((name, before, now),) = sizes(last, first)
    assert (name, before) == ("Quadratic drag: D_2", "–")
    assert "N·m·s²/rad²" in now


def test_the_picture_has_a_gap_where_a_channel_was_not_measured() -> None:
    made = curves([round(1, Status.UNKNOWN, {"theta_l": 2.0}), round(2, Status.UNKNOWN, {"tau_m": 3.0})])
    assert made["rounds.tau_m.after"][1] == 3.0
    assert made["rounds.tau_m.after"][0] != made["rounds.tau_m.after"][0]
    assert "rounds.tau_l.after" not in made
    assert "Kinematic error 9.00 to 2.00; Motor torque 9.00 to 3.00." in say(made)
