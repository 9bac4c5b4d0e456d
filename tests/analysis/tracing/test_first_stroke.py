"""What a locked run did before its first reversal is nobody's evidence; all after it is."""

import numpy as np
import pytest

from rig.analysis.tracing.runs.first_stroke import first_reversal

TRIANGLE = np.interp(np.arange(5000), [0, 1000, 3000, 5000], [0.0, 1.0, -1.0, 1.0])


def test_a_cycle_from_the_middle_begins_at_its_first_reversal() -> None:
    assert first_reversal(TRIANGLE) == 1000
    assert first_reversal(-TRIANGLE) == 1000


def test_a_run_that_begins_at_a_reversal_is_evidence_from_its_first_row_on() -> None:
    assert first_reversal(TRIANGLE[1000:]) == 0


def test_a_ramp_that_never_turns_back_stays_whole() -> None:
    assert first_reversal(np.linspace(0.0, 1.0, 1000)) == 0
    assert first_reversal(np.zeros(1000)) == 0


def test_steps_of_a_motor_that_sticks_and_slips_are_no_reversals(rng: np.random.Generator) -> None:
    slips = np.round(TRIANGLE / 0.1) * 0.1 + 1e-3 * rng.standard_normal(TRIANGLE.size)
    assert first_reversal(slips) == pytest.approx(1000, abs=60)
