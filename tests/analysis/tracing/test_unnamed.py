"""Curves without a name are added one after another, each beside those before it, while unseen runs vouch for them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.outcome.result import Curve
from rig.report.trace.words import added, remainder
from tests.analysis.tracing.spiked import Columns, spiked
from tests.report.trace import made_up

CAGE, BALLS = 0.4437, 12.63  # orders of a bearing, of the motor
RUNS = ("slow_ke_1", "slow_ke_2", "load_20nm_1", "load_20nm_2", "speed_60rpm_1", "speed_60rpm_2", "speed_300rpm_1")


def bearing(c: Columns, began: float) -> Columns:
    """The load angle reads two orders that are none of the gear's."""
    return {"theta_l": c["theta_l"] + 1.5e-5 * np.cos(CAGE * c["theta_m"]) + 1.2e-5 * np.cos(BALLS * c["theta_m"])}


@pytest.mark.slow
@pytest.mark.long
def test_a_bearing_of_two_orders_is_two_curves_and_nothing_is_left(tmp_path: Path, shared: Path) -> None:
    found = spiked(tmp_path / "two", shared / "cases" / "open-1", bearing, RUNS)
    assert (found.verdict.status, found.verdict.coordinate) == (Status.UNKNOWN, "motor_angle")
    orders = sorted(c.order for c in found.added_curves[:2] if c.order is not None)
    assert orders == pytest.approx([CAGE, BALLS], rel=1e-2)
    assert all(c.channel == "theta_l" for c in found.added_curves[:2])
    assert found.ratios_before["theta_l"] > 2.5
    assert found.ratios_after["theta_l"] == pytest.approx(found.added_curves[-1].over_floor, rel=0.02)
    assert found.ratios_after["theta_l"] < 1.3


def test_every_curve_is_told_with_its_place_and_what_all_of_them_leave() -> None:
    one = made_up.unknown()
    assert added(one).startswith("A curve without a name, in the load angle, order 37 per turn; no physics")
    form = Curve("load_angle", "theta_l", None, None, 1.2, "friction of the load: waves of the output's angle")
    said = added(replace(one, added_curves=(form,)))
    assert "(friction of the load: waves of the output's angle; of what unseen runs vouch for there the" in said
    further = Curve("motor_angle", "theta_l", 12.63, None, 1.1), Curve("load", "tau_m", None, None, 1.2)
    said = added(replace(one, added_curves=(*one.added_curves, *further)))
    assert "beside it others in the motor angle, order 12.63 per turn and the torque through the gear" in said
    assert "kinematic error 1.1 times and motor torque 1.2 times its floor" in said


def test_what_curves_leave_beside_names_is_told_apart_from_what_the_names_leave() -> None:
    base = made_up.explained()
    by_names = base.ratios_after | {"theta_l": 2.15}
    curve = Curve("load", "theta_l", None, None, 1.2)
    partly = replace(base, ratios_named=by_names, added_curves=(curve,))
    said = "the kinematic error stays at 2.15 times its floor. What that is, is not known"
    assert f"{said}; a curve without a name in the torque through the gear, for which no physics is claimed, " in (
        remainder(partly)
    )
    assert remainder(partly).endswith("leaves the kinematic error at 1.2 times its floor.")
    assert remainder(replace(base, ratios_named=by_names)).endswith(f"{said}.")
    assert remainder(base) == ""
    assert (partly.by_names["theta_l"], base.by_names) == (2.15, base.ratios_after)
