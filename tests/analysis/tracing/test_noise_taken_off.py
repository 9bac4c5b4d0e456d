"""Sensor noise is taken off the normal equations, and never so much that they have no least squares any more."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.tracing.fit.model import share_taken


def test_little_noise_is_taken_off_whole(rng: np.random.Generator) -> None:
    z = rng.standard_normal((200, 5))
    assert share_taken(z.T @ z, 0.1 * np.eye(5)) == 1.0


def test_no_noise_and_columns_nobody_measured_are_no_trouble(rng: np.random.Generator) -> None:
    z = np.pad(rng.standard_normal((200, 4)), ((0, 0), (0, 1)))
    assert share_taken(z.T @ z, np.zeros((5, 5))) == 1.0


@pytest.mark.parametrize("scale", [1.0, 1e-4, 1e5])
def test_half_of_every_sum_of_columns_is_left_whatever_their_units(rng: np.random.Generator, scale: float) -> None:
    """Two columns nearly alike: noise that is small beside each is more than their difference."""
    z = rng.standard_normal((2000, 3))
    z[:, 2] = z[:, 1] + 0.01 * z[:, 2]
    z *= np.array([1.0, 1.0, scale])
    gram, noise = z.T @ z, np.diag([0.0, 1.0, scale**2])
    assert np.linalg.eigvalsh(np.diag([1, 1, 1 / scale]) @ (gram - noise) @ np.diag([1, 1, 1 / scale]))[0] < 0
    taken = share_taken(gram, noise)
    assert 0.0 < taken < 1.0
    root = np.linalg.cholesky(gram)
    left = np.linalg.solve(root, np.linalg.solve(root, gram - taken * noise).T)
    assert np.linalg.eigvalsh(left)[0] == pytest.approx(0.5, rel=1e-3)
