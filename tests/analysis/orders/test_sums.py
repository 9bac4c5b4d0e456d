"""Least squares from sums: the same coefficients as a plain fit, in blocks, without bias."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from rig.analysis.orders.sums import BLOCK, Sums, fit, harmonics, legendre, without

small = st.floats(-50.0, 50.0, allow_nan=False, width=32)


@settings(max_examples=30, deadline=None)
@given(
    a=st.lists(small, min_size=15, max_size=15), b=st.lists(small, min_size=15, max_size=15), seed=st.integers(0, 99)
)
def test_fourier_coefficients_of_a_whole_turn_come_back_whatever_the_spacing_of_the_rows(
    a: list[float], b: list[float], seed: int
) -> None:
    theta = np.sort(np.random.default_rng(seed).uniform(0, 2 * np.pi, 900))
    truth = np.array(a + b)
    columns = harmonics(theta, 15)
    found = Sums.of(columns, truth @ columns).solve()
    assert np.allclose(found, truth, atol=1e-6)


def test_harmonics_are_cosines_then_sines() -> None:
    theta = np.linspace(-9, 9, 50)
    columns = harmonics(theta, 3)
    assert np.allclose(columns[1], np.cos(2 * theta))
    assert np.allclose(columns[5], np.sin(3 * theta))


def test_legendre_polynomials_are_those_of_numpy() -> None:
    u = np.linspace(-1, 1, 40)
    assert np.allclose(legendre(u, 9), np.polynomial.legendre.legvander(u, 9).T)


def test_blocks_add_up_to_the_whole() -> None:
    rng = np.random.default_rng(3)
    x = rng.standard_normal((4, 2 * BLOCK + 77))
    y = rng.standard_normal(x.shape[1])

    def columns(lo: int, hi: int) -> np.ndarray:
        return x[:, lo:hi]

    plain = np.linalg.lstsq(x.T, y, rcond=None)[0]
    assert np.allclose(fit(columns, y), plain)
    assert np.allclose(without(columns, y, plain), y - plain @ x)
    sums = Sums.of(x, y)
    assert np.isclose(sums.residual(plain), np.sum((y - plain @ x) ** 2))


def test_harmonics_go_into_the_room_they_are_given() -> None:
    theta, room = np.linspace(-3.0, 40.0, 50), np.full((8, 64), np.nan)
    given = harmonics(theta, 3, room[1:7, :50])
    assert np.shares_memory(given, room)
    assert np.array_equal(room[1:7, :50], harmonics(theta, 3))
    assert np.isnan(room[[0, 7]]).all()
    assert np.isnan(room[:, 50:]).all()
