"""Samples that are not what the manifest says settle no limit, and the analysis says what is wrong with them."""

from __future__ import annotations

import tracemalloc
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from rig.analysis import Verdict, analyse
from rig.analysis.kinematic_error.ratio import doubt
from rig.analysis.motion.source import Motion
from rig.runfile.promised import rows_gone, time_untold
from tests.analysis.synthetic import MadeRun, slow_run

PEAK = "kinematic_error_peak_to_peak"


def made(**manifest: Any) -> MadeRun:
    run = slow_run(1)
    return replace(run, manifest={**run.manifest, **manifest})


@pytest.mark.parametrize("limit", [1000.0, 1.0])
def test_missing_rows_are_counted_and_no_limit_is_met_or_missed(limit: float) -> None:
    limits = {PEAK: limit}
    whole = made(limits=limits, rows=200_000)
    assert analyse(whole).verdict is (Verdict.PASS if limit > 100 else Verdict.FAIL)
    part = replace(whole, columns={name: c[:150_000] for name, c in whole.columns.items()})
    result = analyse(part)
    assert result.verdict is Verdict.INCONCLUSIVE
    assert "50000 of the 200000 rows this run was closed with are missing" in result.sentence
    assert [c.name for c in result.checks if not c.passed and c.name == "as_recorded"]


def test_a_doubt_of_the_caller_counts_as_well() -> None:
    result = analyse(made(limits={PEAK: 1000.0}), doubt="the file was changed")
    assert result.verdict is Verdict.INCONCLUSIVE
    assert result.sentence.startswith("The samples are not what the manifest says: the file was changed.")


@pytest.mark.parametrize(("factor", "unit"), [(1e3, "ms"), (1e6, "µs"), (1 / 60, "min")])
@pytest.mark.parametrize("about", [{"loop": {"rate": 1000.0}}, {"duration": 199.999}])
def test_time_in_another_unit_is_named(factor: float, unit: str, about: dict[str, Any]) -> None:
    run = made(**about)
    assert not time_untold(run.manifest, run.column("t"))
    t = run.columns["t"] * factor
    said = time_untold(run.manifest, t)
    assert said.endswith(f": it looks like {unit}, expected s")
    result = analyse(replace(run, columns={**run.columns, "t": t}))
    assert result.verdict is Verdict.INCONCLUSIVE
    assert said in result.sentence


@pytest.mark.parametrize("odd", [None, "word", [1], float("nan"), {"rate": "fast"}, -1, 0])
def test_what_a_manifest_says_oddly_promises_nothing(odd: Any) -> None:
    about = {"rows": odd, "loop": odd, "duration": odd, "files": odd}
    assert rows_gone(about, 10) == ""
    assert time_untold(about, slow_run(1).column("t")) == ""


def test_the_time_of_a_long_run_is_looked_at_in_little_memory() -> None:
    t = np.arange(3_000_000) / 1000.0
    tracemalloc.start()
    try:
        assert time_untold({"loop": {"rate": 1000.0}, "duration": 3000.0}, t) == ""
        assert tracemalloc.get_traced_memory()[1] < 3e6  # bytes, modules it loads included; a copy has 24e6
    finally:
        tracemalloc.stop()


def test_whether_a_long_run_has_another_ratio_is_looked_at_in_little_memory() -> None:
    theta_l = np.linspace(0.0, 10.0, 3_000_000)
    tau_l = np.full(3_000_000, 7160.0)  # N·m: a constant torque winds the gear up and turns nothing
    motion = Motion(50.0, 50.2 * theta_l, theta_l, None, None)
    tracemalloc.start()
    try:
        assert "The encoders turn 50.2 to 1, declared 50" in doubt(motion, tau_l, 7160.0)
        assert tracemalloc.get_traced_memory()[1] < 2e6  # bytes; a copy of the column has 24e6
    finally:
        tracemalloc.stop()


def test_a_locked_output_that_turns_has_no_stiffness() -> None:
    result = analyse(made(procedure="stiffness_lock", limits={"K": "7000.."}))
    assert result.verdict is Verdict.INCONCLUSIVE
    assert "it says its output is locked, and its load angle goes" in result.sentence
    assert not [e.name for e in result.estimates if "stiffness" in e.name or e.name.startswith("K")]


def test_any_run_that_says_it_is_locked_has_to_be() -> None:
    told = made(conditions={"output_locked": True}, limits={PEAK: 1000.0})
    assert analyse(told).verdict is Verdict.INCONCLUSIVE
