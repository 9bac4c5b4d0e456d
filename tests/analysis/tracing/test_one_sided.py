"""Cogging that is no more than the difference of friction between the two ways."""

from __future__ import annotations

import pytest

from rig.analysis.tracing.selection.one_sided import one_sided
from rig.model.effect import Parameter, parameter


def waves(*orders: tuple[int, float, float]) -> tuple[Parameter, ...]:
    """Order, amplitude [N·m] and phase [rad], known to a per cent and to 0.02 rad."""
    made = []
    for order, amplitude, phase in orders:
        made.append(parameter(f"order_{order}_amplitude", amplitude, 0.01 * amplitude, "N·m"))
        made.append(parameter(f"order_{order}_phase", phase, 0.02, "rad"))
    return tuple(made)


RUB = waves((1, 0.010, 3.12), (2, 0.0075, -0.02), (3, 0.005, 3.1))


def said(*cogging: tuple[int, float, float]) -> str:
    return one_sided({"position_dependent_friction": RUB, "cogging_torque": waves(*cogging)})


def test_waves_in_phase_with_the_friction_are_its_own_and_it_is_said_which_way_it_is_larger() -> None:
    assert "larger forward: 2.5 ± 0.025 mN·m of order 1" in said((1, 0.0025, -3.1), (2, 0.0019, 0.0))
    assert "larger backward" in said((1, 0.0025, 0.0), (2, 0.0019, 3.1))


@pytest.mark.parametrize(
    "cogging",
    [
        [(1, 0.0025, 1.5)],  # another phase
        [(1, 0.0025, -3.1), (2, 0.0019, 3.1)],  # forward of one order, backward of the next
        [(1, 0.008, -3.1)],  # friction would hardly be there one way
        [(1, 0.0025, -3.1), (6, 0.0019, 0.0)],  # an order that the friction has not
    ],
)
def test_other_waves_are_cogging(cogging: list[tuple[int, float, float]]) -> None:
    assert not said(*cogging)


def test_either_alone_is_what_it_is() -> None:
    assert not one_sided({"cogging_torque": RUB})
    assert not one_sided({"position_dependent_friction": RUB})
