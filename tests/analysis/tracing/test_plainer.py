"""A ripple that cogging explains more than is cogging, one that goes with the torque stays; a stiffness that follows a
temperature is said to."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import design, fit
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.selection.plainer import plainer
from rig.analysis.tracing.trace import trace
from rig.model.effects import LIBRARY
from rig.model.effects.torque_ripple import TorqueRipple
from tests.analysis.tracing.spiked import Columns, change, started

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
    assert [term.name for term in plainer(found, p.split.fitted).design.terms] == [expected]


@pytest.mark.slow
def test_beside_cogging_of_its_order_a_ripple_is_left_as_it_is(tmp_path: Path, shared: Path) -> None:
    p = prepare(read_campaign(change(tmp_path, shared / "cases" / "open-1", cogging, RUNS)), ())
    terms = (Term(LIBRARY["torque_ripple"], (12.0, TorqueRipple.BY_SIZE)), Term(LIBRARY["cogging_torque"], (12.0,)))
    both = fit(design(p.eq, terms, p.split.fitted))
    assert plainer(both, p.split.fitted) is both


def softer(c: Columns, warmth: float) -> Columns:
    """Half a per cent a kelvin."""
    return {"theta_l": c["theta_l"] - 0.005 * warmth * c["tau_l"] / 7200.0, "oil": np.full(c["t"].size, 22.0 + warmth)}


@pytest.mark.slow
@pytest.mark.parametrize("logged", [pytest.param(logged, marks=pytest.mark.long) for logged in (True, False)])
def test_a_stiffness_that_follows_a_logged_temperature_drifts_with_no_time(
    logged: bool, tmp_path: Path, shared: Path
) -> None:
    for run in sorted((shared / "cases" / "open-1").glob("*_[12]")):
        table = pq.read_table(run / "samples.parquet")
        warmth = 4.0 * (int(started(run)) % 7) / 7
        made = {name: table[name].to_numpy() for name in table.column_names}
        made |= softer(made, warmth)
        unit = {"unit": "degC" if logged else "1"}
        fields = [*table.schema, pa.field("oil", pa.float64(), metadata=unit)]
        shutil.copytree(run, tmp_path / run.name)
        pq.write_table(pa.table(list(made.values()), schema=pa.schema(fields)), tmp_path / run.name / "samples.parquet")
    verdict = trace(tmp_path).verdict
    assert verdict.effects == ()
    assert (verdict.coordinate == "temperature") is logged


EVEN = [f"speed_{speed}rpm_{n}" for speed in ("60", "120", "200", "300", "400", "minus200") for n in (1, 2)]


def squared(c: Columns, began: float) -> Columns:
    omega = np.gradient(c["theta_m"], c["t"])
    return {"tau_m": c["tau_m"] + 2e-4 * omega * abs(omega) / 10}


def falling(c: Columns, began: float) -> Columns:
    omega = np.gradient(c["theta_m"], c["t"])
    return {"tau_m": c["tau_m"] + 0.03 * np.sign(omega) * np.exp(-((omega / 8) ** 2))}


@pytest.mark.slow
@pytest.mark.parametrize(("law", "expected"), [(squared, "quadratic_drag"), (falling, "stribeck_friction")])
def test_a_square_of_the_speed_is_no_friction_that_falls(law: Law, expected: str, tmp_path: Path, shared: Path) -> None:
    p = prepare(read_campaign(change(tmp_path, shared / "cases" / "open-1", law, EVEN)), ())
    runs = p.split.fitted
    wide = [(speed, 2.0, 0.0, law) for speed in (8.0, 14.0) for law in (0.0, 1.0)]
    tried = [fit(design(p.eq, (Term(LIBRARY["stribeck_friction"], one),), runs)) for one in wide]
    found = max(tried, key=lambda s: s.gain)
    assert [term.name for term in plainer(found, runs).design.terms] == [expected]
