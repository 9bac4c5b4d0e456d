"""The columns of the three equations are what the paper's equations say."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit.channels import ORDERS
from rig.analysis.tracing.fit.columns import series, slopes
from rig.analysis.tracing.fit.rows import is_measured
from rig.model.effect import MEASURED


@pytest.mark.slow
def test_the_series_is_cosine_and_sine_of_each_order_in_turn() -> None:
    theta = np.linspace(-7, 7, 50)
    values = series(theta)
    for n in range(1, ORDERS + 1):
        assert values[:, 2 * n - 2] == pytest.approx(np.cos(n * theta), abs=1e-12)
        assert values[:, 2 * n - 1] == pytest.approx(np.sin(n * theta), abs=1e-12)


def test_the_slopes_are_its_derivatives() -> None:
    theta, h = np.linspace(-7, 7, 50), 1e-6
    assert slopes(theta) == pytest.approx((series(theta + h) - series(theta - h)) / (2 * h), abs=1e-6)


@pytest.mark.parametrize(
    ("missing", "said"), [(set(), "AMRL"), ({"tau_l"}, "AM"), ({"theta_l"}, "MRL"), ({"tau_m"}, "AL")]
)
def test_a_channel_says_something_of_what_was_measured_and_reversals_need_the_torque_sensor(
    missing: set[str], said: str
) -> None:
    run: Any = SimpleNamespace(
        procedure="kinematic_error", locked=False, input_locked=False, knows=MEASURED - missing, is_wound=False
    )
    assert "".join(channel for channel in "AMRL" if is_measured(run, channel)) == said


def test_of_a_lock_test_without_a_torque_sensor_the_angles_are_spent_on_the_torque() -> None:
    run: Any = SimpleNamespace(
        procedure="stiffness_lock",
        locked=True,
        input_locked=False,
        knows=MEASURED - {"tau_l"},
        is_wound=True,
        look=SimpleNamespace(held_load=False, reversals=False),
    )
    assert "".join(channel for channel in "AMRL" if is_measured(run, channel)) == "M"
