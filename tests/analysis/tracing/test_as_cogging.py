"""A ripple that cogging explains more than is cogging, and one that goes with the torque stays."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import design, fit
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.selection.as_cogging import as_cogging
from rig.model.effects import LIBRARY
from rig.model.effects.torque_ripple import TorqueRipple
from tests.analysis.tracing.spiked import Columns, change

Law = Callable[[Columns, float], Columns]
RUNS = [f"speed_{speed}rpm_{n}" for speed in ("60", "120", "200", "minus200") for n in (1, 2)]


def cogging(c: Columns, began: float) -> Columns:
    return {"tau_m": c["tau_m"] + 0.006 * np.cos(12 * c["theta_m"])}


def ripple(c: Columns, began: float) -> Columns:
    return {"tau_m": c["tau_m"] + 0.03 * np.abs(c["tau_m"]) * np.cos(12 * c["theta_m"])}


@pytest.mark.slow
@pytest.mark.parametrize(("law", "expected"), [(cogging, "cogging_torque"), (ripple, "torque_ripple")])
def test_whichever_explains_more_stands(law: Law, expected: str, tmp_path: Path, shared: Path) -> None:
    p = prepare(read_campaign(change(tmp_path, shared / "cases" / "open-1", law, RUNS)), ())
    found = fit(design(p.eq, (Term(LIBRARY["torque_ripple"], (12.0, TorqueRipple.BY_SIZE)),), p.split.fitted))
    assert [term.name for term in as_cogging(found, p.split.fitted).design.terms] == [expected]


@pytest.mark.slow
def test_beside_cogging_of_its_order_a_ripple_is_left_as_it_is(tmp_path: Path, shared: Path) -> None:
    p = prepare(read_campaign(change(tmp_path, shared / "cases" / "open-1", cogging, RUNS)), ())
    terms = (Term(LIBRARY["torque_ripple"], (12.0, TorqueRipple.BY_SIZE)), Term(LIBRARY["cogging_torque"], (12.0,)))
    both = fit(design(p.eq, terms, p.split.fitted))
    assert as_cogging(both, p.split.fitted) is both
