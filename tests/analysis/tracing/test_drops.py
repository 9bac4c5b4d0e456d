"""What a term would explain is asked only of directions that are better known than what noise, taken off, left."""

from __future__ import annotations

import numpy as np

from rig.analysis.tracing.fit.scan import _drop

NONE = np.zeros((2, 2))
MODEL = np.zeros((1, 2))  # nothing that the term leans on


def test_a_term_of_its_own_explains_what_it_is() -> None:
    gram, x = np.diag([4.0, 9.0]), np.array([0.5, -2.0])
    found = _drop(3, gram, NONE, MODEL, gram @ x)
    np.testing.assert_allclose(found.coefficients, x)
    np.testing.assert_allclose(found.drop, x @ gram @ x)


def test_a_direction_that_is_less_its_own_than_another_is_below_nothing_explains_nothing() -> None:
    """Of a wave that a model has already, noise taken off leaves −6e-3 of a column here and 2e-3 there: rounding of
    what was taken off, by which anything could be explained."""
    gram = np.eye(2)
    model = np.diag(np.sqrt([1.006, 0.998]))
    assert _drop(0, gram, NONE, model, np.array([0.0, 1.0])).drop == 0.0
    better = np.diag(np.sqrt([1.006, 0.98]))
    assert _drop(0, gram, NONE, better, np.array([0.0, 1.0])).drop > 0.0
