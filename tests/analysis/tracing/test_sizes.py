"""An effect of which every size may be nothing."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing.selection.asked import Asked
from rig.analysis.tracing.selection.sizes import may_be_nothing
from rig.model.effect import Parameter
from rig.model.effects import LIBRARY


@pytest.mark.parametrize(
    ("loss", "there", "nothing"), [(0.4, 3.3, True), (0.4, 0.1, False), (-0.4, 0.1, False), (None, 0.0, False)]
)
def test_a_size_that_holds_zero_may_be_nothing(loss: float | None, there: float, nothing: bool) -> None:
    """Drag of 0.4 ± 3.3 N·m; of an effect that is told with nothing nothing is said."""
    words = () if loss is None else (Parameter("drag_at_10_rad_s", loss, (loss - there, loss + there), "N·m"),)
    assert may_be_nothing(LIBRARY["quadratic_drag"], words) is nothing


@pytest.mark.parametrize(("half", "sized", "measured"), [(0.1, True, True), (0.5, True, False), (1.2, False, False)])
def test_what_is_measured_to_a_third_is_more_than_what_is_not_nothing(half: float, sized: bool, measured: bool) -> None:
    name = "angle_dependent_stiffness"
    words = {name: (Parameter("kappa_order_2_amplitude", 0.05, (0.05 * (1 - half), 0.05 * (1 + half)), "1"),)}
    asked: Any = SimpleNamespace(names=(name,), words=words)
    asked.sized = Asked.sized.func(asked)
    assert (name in asked.sized) is sized
    assert (name in Asked.measured.func(asked)) is measured


@pytest.mark.parametrize(("half", "nothing"), [(0.05, False), (1.3, True)])
def test_a_resonance_that_may_as_well_not_swing_may_be_nothing(half: float, nothing: bool) -> None:
    """What is left of it then is an inertia, as the gear has one."""
    words = (
        Parameter("J_2", 0.68, (0.5, 0.86), "kg·m²"),
        Parameter("frequency", 58.7, (53.0, 64.4), "Hz"),
        Parameter("zeta", 0.04, (0.04 - half, 0.04 + half), "1"),
    )
    assert may_be_nothing(LIBRARY["torsional_mode"], words) is nothing
