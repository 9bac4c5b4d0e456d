"""What of the kinematic error is left under one sign of the torque more than under the other is no spring."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.fit.bank import reach
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import design, fit
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.selection.uneven_fall import uneven_fall
from rig.model.effect import Fit, Port
from rig.model.effects import LIBRARY
from rig.model.effects.load_dependent_kinematic_error import EACH, SIDED
from tests.analysis.tracing.spiked import STIFFNESS, Columns, change
from tests.contract.test_effects import KNOWN, motion

FALL, SPRING = LIBRARY["load_dependent_kinematic_error"], LIBRARY["angle_dependent_stiffness"]
SHAPE = (SIDED, 4.0, 3e-3, 1.0)


def test_it_has_the_sign_of_the_torque_and_nothing_without() -> None:
    made = FALL.columns(motion(), SHAPE)
    assert made.keys() == {Port.KINEMATIC_ERROR, Port.LEVER}
    s, uneven = motion(), made[Port.KINEMATIC_ERROR][:, 0]
    plainly = np.abs(s.torque) > 2.0  # the lag is behind where it turns
    assert np.all((uneven * s.torque * s.series_value)[plainly] >= 0)
    assert np.abs(uneven[np.abs(s.torque) < 0.1]).max() < 0.1 * np.abs(s.series_value).max()


def test_of_what_there_is_without_load_it_is_no_part() -> None:
    assert not FALL.unloaded(2, KNOWN, SHAPE).any()
    fits = [Fit(np.array([d]), SHAPE, np.eye(5) * 1e-6, KNOWN, 50.0) for d in (0.1, 1.2)]
    assert [FALL.plausible(one) for one in fits] == [True, False]
    (uneven,) = FALL.parameters(fits[0])
    assert (uneven.name, uneven.value, uneven.unit) == ("uneven", 0.1, "1")
    assert FALL.together("A_inf", [Fit(np.array([0.5]), (0.0, *SHAPE[1:]), np.eye(5), KNOWN, 50.0), fits[0]]) == (
        pytest.approx(1 / 1.5)
    )


@pytest.mark.long
@pytest.mark.parametrize("springs", [False, True])
def test_it_takes_the_place_of_a_spring_that_changes_with_the_angle_where_there_is_none(
    springs: bool, shared: Path, tmp_path: Path
) -> None:
    truth = json.loads((shared / "cases" / "TRUTH.json").read_text())["open-1"]
    a, b = (np.array(truth[f"kinematic_error_{x}_rad"]) for x in "ab")

    def law(c: Columns, began: float) -> Columns:
        angles, torque = np.outer(c["theta_m"], np.arange(a.size)), c["tau_l"]
        left = 0.6 + (0.0 if springs else 0.05) * np.sign(torque)
        gone = (1 - left) * (1 - np.exp(-np.abs(torque) / 4.0))
        wound = torque / STIFFNESS * 0.015 * np.cos(2 * c["theta_m"] + 1.0) * springs
        return {"theta_l": c["theta_l"] + gone * (np.cos(angles) @ a + np.sin(angles) @ b) - wound}

    p = prepare(read_campaign(change(tmp_path, shared / "cases" / "open-1", law)), ())
    runs = p.split.fitted
    s = fit(design(p.eq, (Term(FALL, (EACH, 4.0, 3e-3, 1.0)), Term(SPRING, (2.0, 0.0, 0.0))), runs))
    told = uneven_fall(s, runs, reach([p.eq.runs[i] for i in runs]))
    assert (SPRING.name in {term.name for term in told.design.terms}) == springs
    if not springs:
        assert told.design.terms[-1].shape[0] == SIDED
