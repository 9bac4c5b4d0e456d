"""Sensor noise is taken off the normal equations, and never so much that they have no least squares any more."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.tracing.fit.model import held_still, share_taken


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


@pytest.mark.parametrize("scale", [1.0, 1e-5])
def test_the_difference_of_two_columns_that_is_noise_stays_at_nothing_and_their_sum_is_free(
    rng: np.random.Generator, scale: float
) -> None:
    """What is taken off leaves next to nothing of the difference: whatever y has along it would seem to be explained by
    a coefficient without bounds."""
    along, across = np.array([1.0, 1.0]), np.array([1.0, -1.0])
    z = rng.standard_normal((2000, 2))
    z[:, 1] = z[:, 0] + 0.03 * z[:, 1]
    noise = 0.4 * np.outer(across, across)
    own = z.T @ z - noise
    assert 0 < across @ own @ across < across @ noise @ across
    own, noise, right = scale**2 * own, scale**2 * noise, scale * (own @ (5.0 * along) + 2.0 * across)
    free = scale * np.linalg.solve(own, right)
    held = scale * np.linalg.solve(own + held_still(np.eye(1), np.zeros((1, 2)), own, noise), right)
    assert abs(across @ held) < 0.05 * abs(across @ free)
    assert along @ held == pytest.approx(10.0, rel=0.01)


def test_clear_columns_are_not_held(rng: np.random.Generator) -> None:
    z = rng.standard_normal((2000, 2))
    assert not held_still(np.eye(1), np.zeros((1, 2)), z.T @ z, 10.0 * np.eye(2)).any()
