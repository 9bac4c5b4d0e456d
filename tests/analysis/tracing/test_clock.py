"""What a clock that jitters, or rows that were lost, do to the even grid on which a run is taken."""

import numpy as np
import pytest

from rig.analysis.tracing.runs.recording import _between, _uniform

PERIOD = 1e-3


def stamps(rng: np.random.Generator, lost: float) -> np.ndarray:
    """Of rows that come up to some tens of µs late, and of which a share is lost."""
    t = PERIOD * np.arange(10_000) + np.abs(rng.normal(0.0, 2e-5, 10_000))
    return t[rng.random(t.size) >= lost]


@pytest.mark.parametrize("lost", [0.0, 0.01])
def test_a_wave_that_sampling_folded_over_keeps_its_phase_on_the_even_grid(
    rng: np.random.Generator, lost: float
) -> None:
    t = stamps(rng, lost)
    steps = np.diff(t)
    dt = _between(steps)
    grid = np.arange(t[0], t[-1], dt)
    seen = _uniform(t, np.cos(2 * np.pi * 960.0 * t), dt)  # lines of an encoder, at 1 kHz: 40 Hz
    assert np.corrcoef(seen, np.cos(2 * np.pi * 960.0 * grid))[0, 1] > 0.95
    assert abs(dt / PERIOD - 1) < 1e-5 < abs(np.median(steps) / PERIOD - 1), (
        "a median loses a quarter of a turn and more"
    )


@pytest.mark.parametrize("usual", [np.nan, -1e-3])
def test_of_times_that_are_none_no_mean_is_made(usual: float) -> None:
    assert np.array_equal(_between(np.full(5, usual)), usual, equal_nan=True)
