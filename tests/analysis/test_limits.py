"""A limit makes a verdict, with the interval as guard band; what settles nothing says what would."""

import math

import pytest

from rig.analysis.limits import judge
from rig.analysis.result import Estimate, Part, Verdict

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


def test_one_figure_out_of_limits_fails_the_run_whatever_the_others_do() -> None:
    other = Estimate("drift", "Drift", 1.0, "arcsec/min", (0.0, 2.0), "From time.")
    assert judge([FIGURE, other], {"swing": 200.0, "drift": 1.5}).verdict is Verdict.INCONCLUSIVE
    assert judge([FIGURE, other], {"swing": 20.0, "drift": 1.5}).verdict is Verdict.FAIL


def test_what_is_not_settled_names_the_largest_contribution_and_how_narrow_the_interval_would_have_to_be() -> None:
    said = judge([FIGURE], {"swing": 94.0}).unsettled
    assert "narrower than ±1 arcsec" in said
    assert "±1.5 arcsec, is the scatter of 27 revolutions: take more of them" in said
    assert "inertia" not in said


def test_without_known_contributions_it_says_how_the_interval_is_made() -> None:
    bare = Estimate("swing", "Swing", 93.0, "arcsec", (91.4, 94.6), "From five turns.")
    assert "From five turns." in judge([bare], {"swing": 94.0}).unsettled
    unknown = Estimate("swing", "Swing", 93.0, "arcsec", (math.nan, math.nan), "One turn does not repeat.")
    judged = judge([unknown], {"swing": 200.0})
    assert judged.verdict is Verdict.INCONCLUSIVE
    assert "no interval" in judged.unsettled


@pytest.mark.parametrize(
    ("limits", "words"),
    [
        ({"swign": 94.0}, "did you mean 'swing'"),
        ({"swing": {"upper": 1.5, "unit": "arcmin"}}, "in arcmin, the figure in arcsec"),
        ({"swing": {}}, "is no number"),
    ],
)
def test_a_limit_that_cannot_be_judged_is_never_dropped_in_silence(limits: dict[str, object], words: str) -> None:
    judged = judge([FIGURE], limits)
    assert judged.verdict is Verdict.INCONCLUSIVE
    assert words in judged.unsettled
    assert [c.passed for c in judged.checks] == [False]
