"""A friction that falls and a drag that grows are two, where one bent law draws both; one that falls alone is one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.fit.bank import reach
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import design, fit
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.selection.two_for_one import two_for_one
from rig.model.effects import LIBRARY
from rig.model.effects.stribeck_friction import StribeckFriction
from tests.analysis.tracing.spiked import Columns, change

FALL = LIBRARY["stribeck_friction"]
BENT = Term(FALL, (2.7, 1.0, 0.0, StribeckFriction.FILM))
PLAIN = Term(FALL, (2.5, 2.0, 0.0, StribeckFriction.EXPONENTIAL))
KINDS = ("slow_ke", *(f"speed_{rpm}rpm" for rpm in ("60", "120", "200", "300", "400", "minus60", "minus400")))
RUNS = [f"{kind}_{n}" for kind in KINDS for n in (1, 2)]


def omega(c: Columns) -> np.ndarray:
    return np.asarray(np.gradient(c["theta_m"], c["t"]))


def fall(c: Columns) -> np.ndarray:
    return np.asarray(0.03 * np.sign(omega(c)) * np.exp(-((omega(c) / 2.5) ** 2)))


def drag(c: Columns) -> np.ndarray:
    return np.asarray(3e-5 * omega(c) * np.abs(omega(c)))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("both", "found", "names"),
    [
        pytest.param(True, BENT, ["quadratic_drag", "stribeck_friction"], marks=pytest.mark.long),
        pytest.param(False, PLAIN, ["stribeck_friction"], marks=pytest.mark.long),
        (False, BENT, ["stribeck_friction"]),
    ],
)
def test_two_plain_laws_take_the_place_of_a_bent_one_only_where_both_are_there(
    both: bool, found: Term, names: list[str], tmp_path: Path, shared: Path
) -> None:
    def law(c: Columns, began: float) -> Columns:
        return {"tau_m": c["tau_m"] + fall(c) + (drag(c) if both else 0.0)}

    p = prepare(read_campaign(change(tmp_path, shared / "cases" / "open-1", law, RUNS)), ())
    runs = p.split.fitted
    s = fit(design(p.eq, (found,), runs))
    told = two_for_one(s, runs, reach([p.eq.runs[i] for i in runs]))
    assert sorted(term.name for term in told.design.terms) == names
