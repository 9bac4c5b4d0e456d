"""What may stand for want of something else: a look-alike of what was eliminated, a law without a name."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Solution, design, fit
from rig.analysis.tracing.prepared import Prepared, prepare
from rig.analysis.tracing.residual.unknown import _is_it
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.selection.elimination import _may_stand
from rig.analysis.tracing.selection.further import _stands_in
from rig.analysis.tracing.selection.score import HeldOutScore
from rig.model.effects.gravity_unbalance import GravityUnbalance
from rig.model.effects.torque_sensor_crosstalk import TorqueSensorCrosstalk
from tests.analysis.tracing.spiked import Columns, change
from tests.analysis.tracing.test_signs import RUNS

WEIGHT, CROSSTALK = Term(GravityUnbalance(), (1.0, 0.0)), Term(TorqueSensorCrosstalk(), (1.0, 1.0))
NAMELESS = HeldOutScore("constant_drift", 1.09, 2.4, 0.7, 1.0, (), unsteady=0.3, apart=0.3)


def crosstalk(c: Columns, began: float) -> Columns:
    return {"tau_l": c["tau_l"] + 0.5 * np.cos(c["theta_l"] + 0.4)}


@pytest.mark.slow
def test_a_weight_does_not_stand_for_a_torque_sensor_that_is_read_once_a_turn(shared: Path, tmp_path: Path) -> None:
    p = prepare(read_campaign(change(tmp_path, shared / "cases" / "open-1", crosstalk, RUNS)), ())
    as_weight, as_read = fitted(p, WEIGHT), fitted(p, CROSSTALK)
    assert as_read.gain > as_weight.gain
    assert stands_in(p, as_weight, as_read, "torque_sensor_crosstalk")
    assert not stands_in(p, as_read, as_weight, "gravity_unbalance")


def fitted(p: Prepared, term: Term) -> Solution:
    return fit(design(p.eq, (term,), p.split.fitted))


def stands_in(p: Prepared, other: Solution, found: Solution, eliminated: str) -> bool:
    """Whether the term of `other` came in for want of the one that was eliminated of `found`."""
    as_selected, as_found = cast_any(solution=other), cast_any(solution=found)
    return _stands_in(as_selected, (), as_found, {eliminated}, p.split.fitted)


def cast_any(**said: object) -> Any:
    return SimpleNamespace(**said)


def test_a_law_without_a_name_stands_where_it_is_plain_or_repeats_vouch_for_it() -> None:
    assert not NAMELESS.plain
    assert not _may_stand(NAMELESS, [NAMELESS])
    vouched = replace(NAMELESS, as_repeats=True)
    assert _may_stand(vouched, [vouched])


def test_a_step_is_said_before_what_leaves_several_times_as_much_and_only_where_it_is_all() -> None:
    assert _is_it(1.0, 0.94)
    assert not _is_it(0.97, 0.94)  # it leaves half as much: both may follow the order of the runs
    assert not _is_it(1.0, 0.97)  # the coordinate explains all there is as well
