"""What a dry run says of short strokes is what the analysis says of the run."""

from __future__ import annotations

import pytest

from rig.cli import main
from rig.control.profile import Triangle
from rig.core.units import DEG
from rig.procedures.whole_turns import too_short, whole_turns

FOUND = [
    (180, 2.0, (0, 0)),
    (355, 2.0, (0, 0)),
    (358, 2.0, (1, 2)),
    (361, 1.0, (0, 1)),
    (541, 1.0, (1, 2)),
    (720, 1.0, (2, 3)),
    (400, 0.5, (0, 0)),
    (600, 0.5, (0, 1)),
    (720, 0.5, (1, 1)),
    (1440, 0.5, (3, 3)),
]
"""deg, cycles and the forward and reverse revolutions that were found in such runs on the twin."""


@pytest.mark.parametrize(("amplitude", "cycles", "found"), FOUND)
def test_as_many_turns_are_foretold_as_are_found(amplitude: float, cycles: float, found: tuple[int, int]) -> None:
    wave = Triangle(amplitude * DEG, 0.02, cycles)
    assert whole_turns(wave) == found
    said = " ".join(too_short(wave))
    assert ("no kinematic error can be had" in said) is (sum(found) == 0)
    assert ("will have no interval" in said) is (sum(found) > 0 and max(found) == 1)


@pytest.mark.parametrize(("cycles", "least"), [(1.0, 360), (0.5, 540)])
def test_the_amplitude_that_is_asked_for_gives_a_figure(cycles: float, least: float) -> None:
    (said,) = too_short(Triangle(100 * DEG, 0.02, cycles))
    assert f"expected amplitude_deg of {least} deg or more" in said
    assert sum(whole_turns(Triangle(least * DEG, 0.02, cycles))) > 0


@pytest.mark.parametrize(("amplitude", "told"), [("180", True), ("1440", False)])
def test_the_search_for_the_slow_speed_says_it_too(
    amplitude: str, told: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", "speed-convergence", "--with", f"amplitude_deg={amplitude}", "--dry-run"]) == 0
    assert ("no kinematic error can be had" in capsys.readouterr().out) is told
