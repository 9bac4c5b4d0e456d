"""What the fit does not know is not held against unseen runs: orders nobody read, an inertia nothing shook."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from rig.analysis.tracing.fit.channels import BASELINE, INDEX
from rig.analysis.tracing.floor.uncertain import beside, is_inferred

THETA = np.linspace(-1.0, 1.0, 2000)
FLOOR = 4e-6  # rad
KEY = (0, "A")


def block(columns: dict[str, np.ndarray], key: tuple[int, str] = KEY) -> Any:
    at = np.array([INDEX[name] for name in columns])
    z = SimpleNamespace(whole=lambda: np.column_stack([*columns.values()]))
    return SimpleNamespace(parts={key: (SimpleNamespace(z=z, at=at),)})


def known_to(**sigmas: float) -> np.ndarray:
    out = np.zeros((len(BASELINE), len(BASELINE)))
    for name, sigma in sigmas.items():
        out[INDEX[name], INDEX[name]] = sigma**2
    return out


@pytest.mark.parametrize(("sigma", "left"), [(2e-5, 0.1), (0.0, 1.0)])
def test_what_the_orders_are_not_known_to_is_no_residual_and_what_they_are_known_to_is(
    sigma: float, left: float
) -> None:
    """A wave of order 2 that the fit has 20 µrad wrong; once it is as unsure as that, once it is sure."""
    d = block({"a2": np.cos(2 * THETA), "compliance": THETA})
    e = 2e-5 * (np.cos(2 * THETA) - np.cos(2 * THETA).mean())
    rest = beside(e, d, KEY, known_to(a2=sigma), FLOOR)
    assert np.std(rest) <= left * np.std(e) * (1 + 1e-9)
    assert np.std(rest) >= (0.0 if sigma else 1.0) * np.std(e) * (1 - 1e-9)


def test_a_loop_that_no_order_makes_stays() -> None:
    """Hysteresis has two values at one motor angle; uncertain orders have one."""
    way = np.concatenate((THETA, THETA[::-1]))
    loop = 2e-5 * np.concatenate((np.ones(THETA.size), -np.ones(THETA.size)))
    d = block({"a2": np.cos(2 * way), "b1": np.sin(way)})
    assert np.std(beside(loop, d, KEY, known_to(a2=1e-4, b1=1e-4), FLOOR)) == pytest.approx(2e-5, rel=1e-3)


@pytest.mark.parametrize(("sigma", "least", "most"), [(1e-3, 0.0, 0.1), (1e-6, 0.99, 1.0)])
def test_a_reversal_is_not_held_against_an_inertia_that_nothing_else_shook(
    sigma: float, least: float, most: float
) -> None:
    """Half a gram square metre off, at 40 rad/s²: once it is as unsure as that, once it is sure."""
    alpha = 40.0 * np.exp(-(np.linspace(-3, 3, 30) ** 2))
    d = block({"J_m": alpha, "a2": np.ones(30)}, (0, "R"))
    e = 5e-4 * (alpha - alpha.mean())
    rest = beside(e, d, (0, "R"), known_to(J_m=sigma, a2=1.0), 2e-3)
    assert least <= np.std(rest) / np.std(e) <= most


def test_the_motors_torque_and_lock_tests_lean_on_orders_where_no_load_angle_was_read() -> None:
    def of(locked: bool, channel: str, *has: str) -> bool:
        eq = SimpleNamespace(runs=[SimpleNamespace(locked=locked, has=set(has))])
        return is_inferred(cast(Any, eq), (0, channel))

    assert of(True, "A", "theta_m", "tau_l")
    assert of(False, "M", "theta_m", "tau_l")
    assert not of(False, "L", "theta_m", "tau_l")
    assert not of(True, "A", "theta_m", "theta_l", "tau_l")
    assert not of(False, "M", "theta_m", "theta_l", "tau_l")


def test_a_covariance_that_sensor_noise_left_below_zero_moves_nothing_that_way() -> None:
    """Noise taken off the normal matrix can leave it indefinite, and what is known of two orders along with it."""
    known = known_to(a2=1e-5, b2=1e-5)
    known[INDEX["a2"], INDEX["b2"]] = known[INDEX["b2"], INDEX["a2"]] = 3e-10  # beyond what two variances allow
    turn = np.linspace(-np.pi, np.pi, 2000)  # a whole one, on which both waves are as large
    d = block({"a2": np.cos(2 * turn), "b2": np.sin(2 * turn)})
    for sign, least, most in ((1.0, 0.0, 0.2), (-1.0, 0.99, 1.0)):
        e = 1e-5 * (np.cos(2 * turn) + sign * np.sin(2 * turn))
        rest = np.std(beside(e, d, KEY, known, FLOOR)) / np.std(e)
        assert least <= rest <= most * (1 + 1e-9)
