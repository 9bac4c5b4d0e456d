"""Whether the identified gear makes θ̃ at speed what it was measured to be."""

from __future__ import annotations

from rig.analysis.identify.predictions import Prediction, misfit


def run(name: str, rms: float, half: float = 1.4) -> Prediction:
    """Of one run at 310 rpm, ± `half` arcsec peak to peak."""
    return Prediction(name, 310.0, 145.0, (145.0 - half, 145.0 + half), 144.0, 1.0, 93.4, rms)


def test_numbers_that_make_the_error_what_it_is_are_left_alone() -> None:
    assert misfit([run("a", 0.3), run("b", 1.3)]) == ""
    assert misfit([]) == ""


def test_the_run_that_they_miss_most_is_told_with_by_how_much() -> None:
    said = misfit([run("a", 0.3), run("b", 4.2), run("c", 9.8)])
    assert "2 of 3 runs" in said
    assert "9.8 arcsec RMS in c at +310 rpm, 7.0 times half" in said


def test_a_gear_that_does_not_turn_steadily_predicts_nothing_that_could_be_missed() -> None:
    assert misfit([run("a", float("nan")), run("b", 0.5, half=0.0)]) == ""
