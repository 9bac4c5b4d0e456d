"""A limit makes a verdict, with the interval as guard band; what settles nothing says what would."""

import math

import pytest

from rig.analysis.findings.limits import NO_INTERVAL, judge
from rig.analysis.findings.result import Estimate, Part, Verdict

SCATTER = Part("the scatter of 27 revolutions", 1.5, "take more of them")
SPEED = Part("what inertia adds", 0.5, "run slower")
FIGURE = Estimate("swing", "Swing", 93.0, "arcsec", (91.4, 94.6), "From turns.", (SPEED, SCATTER))


@pytest.mark.parametrize(
    ("limit", "verdict"),
    [
        (94.7, Verdict.PASS),
        (94.5, Verdict.INCONCLUSIVE),
        (91.5, Verdict.INCONCLUSIVE),
        (91.3, Verdict.FAIL),
        ({"lower": 91.3}, Verdict.PASS),
        ({"lower": 95.0}, Verdict.FAIL),
        ({"lower": 90.0, "upper": 94.0}, Verdict.INCONCLUSIVE),
        ({"upper": 95.0, "unit": "arcsec"}, Verdict.PASS),
        (None, Verdict.MEASURED),
    ],
)
def test_the_whole_interval_must_lie_on_one_side_of_the_limit(limit: object, verdict: Verdict) -> None:
    assert judge([FIGURE], {"swing": limit}).verdict is verdict


@pytest.mark.parametrize(
    ("unit", "arcsec"), [("arcsec", 1.0), ("arcmin", 60.0), ("deg", 3600.0), ("rad", 206264.806), ("mrad", 206.264806)]
)
def test_a_limit_of_an_angle_is_taken_in_any_of_its_units(unit: str, arcsec: float) -> None:
    for bound, verdict in ((94.7, Verdict.PASS), (93.5, Verdict.INCONCLUSIVE), (91.3, Verdict.FAIL)):
        judged = judge([FIGURE], {"swing": {"upper": bound / arcsec, "unit": unit}})
        assert judged.verdict is verdict
        assert ("arcsec)" in judged.checks[0].sentence.partition("limit")[2]) is (unit != "arcsec")


def test_what_settles_a_converted_limit_is_said_in_the_figures_unit() -> None:
    said = judge([FIGURE], {"swing": {"lower": 1.5, "upper": 1.5667, "unit": "arcmin"}})
    assert "at least 1.5 arcmin and at most 1.5667 arcmin (90 and 94.002 arcsec)" in said.checks[0].sentence
    assert "lies 1 arcsec from 94.002 arcsec" in said.unsettled


def test_a_limit_in_a_quotient_of_units_is_taken_too() -> None:
    stiffness = Estimate("k", "Stiffness", 7160.0, "N·m/rad", (7100.0, 7220.0), "From a loop.")
    assert judge([stiffness], {"k": {"lower": 2.0, "unit": "N·m/arcmin"}}).verdict is Verdict.PASS
    assert judge([stiffness], {"k": {"lower": 2.0, "unit": "N·m/rad/s"}}).verdict is Verdict.INCONCLUSIVE


def test_one_figure_out_of_limits_fails_the_run_whatever_the_others_do() -> None:
    other = Estimate("drift", "Drift", 1.0, "arcsec/min", (0.0, 2.0), "From time.")
    assert judge([FIGURE, other], {"swing": 200.0, "drift": 1.5}).verdict is Verdict.INCONCLUSIVE
    assert judge([FIGURE, other], {"swing": 20.0, "drift": 1.5}).verdict is Verdict.FAIL


def test_what_is_not_settled_names_the_largest_contribution_and_how_narrow_the_interval_would_have_to_be() -> None:
    said = judge([FIGURE], {"swing": 94.0}).unsettled
    assert "narrower than ±1 arcsec" in said
    assert "±1.5 arcsec, is the scatter of 27 revolutions: take more of them" in said
    assert "inertia" not in said


def test_a_run_without_any_figure_is_said_to_have_none() -> None:
    assert "against its limit; it has no figure at all." in judge([], {"swing": 94.0}).unsettled


def test_without_known_contributions_it_says_how_the_interval_is_made() -> None:
    bare = Estimate("swing", "Swing", 93.0, "arcsec", (91.4, 94.6), "From five turns.")
    assert "From five turns." in judge([bare], {"swing": 94.0}).unsettled
    unknown = Estimate("swing", "Swing", 93.0, "arcsec", (math.nan, math.nan), "One turn does not repeat.")
    judged = judge([unknown], {"swing": 200.0})
    assert judged.verdict is Verdict.INCONCLUSIVE
    said = "Swing 93 arcsec has no interval in this run, limit at most 200 arcsec: no verdict can be made."
    assert judged.checks[0].sentence == said
    assert judged.unsettled == f"{said} {NO_INTERVAL} One turn does not repeat."


@pytest.mark.parametrize(
    ("limits", "words"),
    [
        ({"swign": 94.0}, "did you mean 'swing'"),
        ({"swing": {"upper": 1.5, "unit": "parsec"}}, "at most 1.5 parsec, is in no unit of such a figure"),
        ({"swing": {"upper": 1.5, "unit": "N·m"}}, "expected a number in arcsec, rad, mrad, deg, arcmin"),
        ({"swing": {"upper": 1.5, "unit": "counts"}}, "at most 1.5 counts, is in no unit"),
        ({"swing": {}}, "is no number"),
    ],
)
def test_a_limit_that_cannot_be_judged_is_never_dropped_in_silence(limits: dict[str, object], words: str) -> None:
    judged = judge([FIGURE], limits)
    assert judged.verdict is Verdict.INCONCLUSIVE
    assert words in judged.unsettled
    assert [c.passed for c in judged.checks] == [False]


def test_which_limit_a_figure_is_out_of_is_told() -> None:
    assert judge([FIGURE], {"swing": 60.0}).outside == (
        "Swing 93 arcsec (91.4 to 94.6), limit at most 60 arcsec: the whole interval is outside."
    )
    assert not judge([FIGURE], {"swing": 100.0}).outside
