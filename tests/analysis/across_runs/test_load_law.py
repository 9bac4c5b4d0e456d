"""Peak to peak against load as a law, up against down."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from rig.analysis.across_runs.load_law import LoadRun, down_less_up, load_law
from rig.analysis.findings.intervals import Ranged
from rig.evaluation.sweep import runs_of
from rig.report.text.load_law import told

LOADS = (0.0, 0.5, 1.0, 2.0, 3.0, 5.0, 7.5, 10.0, 15.0)  # N·m
P_0, P_INF, T_C = 80.0, 50.0, 2.5  # arcsec, arcsec, N·m


def sweep(seed: int, noise: float = 0.3, fall: float = P_0 - P_INF, lag: float = 0.0) -> list[LoadRun]:
    rng = np.random.default_rng(seed)
    return [
        LoadRun(T, P_INF + fall * np.exp(-T / T_C) + lag * down + noise * rng.standard_normal(), down)
        for down in (False, True) for T in LOADS
    ]  # fmt: skip


def covers(found: Ranged, true: float) -> bool:
    return found.low <= true <= found.high


def test_the_law_is_found_and_its_intervals_hold_the_truth_as_often_as_they_say() -> None:
    laws = [law for seed in range(200) if (law := load_law(sweep(seed))) is not None]
    assert len(laws) == 200
    for name, true in (("P_0", P_0), ("P_inf", P_INF), ("T_c", T_C)):
        assert np.mean([getattr(law, name).value for law in laws]) == pytest.approx(true, rel=0.01), name
        assert np.mean([covers(getattr(law, name), true) for law in laws]) >= 0.92, name
    assert np.mean([law.rms for law in laws]) == pytest.approx(0.3, rel=0.15)


def test_a_gear_that_load_does_not_change_is_said_to_be_so() -> None:
    flat = [load_law(sweep(seed, fall=0.0)) for seed in range(100)]
    assert np.mean([law is not None and law.falls for law in flat]) <= 0.05
    assert any("no difference that is told from none" in line for line in told(sweep(1, fall=0.0)))


def test_what_the_way_down_adds_is_told() -> None:
    apart, none = down_less_up(sweep(2, lag=1.0)), down_less_up(sweep(2))
    assert apart is not None
    assert none is not None
    assert covers(apart, 1.0)
    assert apart.low > 0.0
    assert covers(none, 0.0)


def test_too_few_loads_give_a_table_and_no_law() -> None:
    few = [LoadRun(T, 80.0 - T, False) for T in (0.0, 2.0, 4.0)]
    assert load_law(few) is None
    assert "no law fitted" in told(few)[-1]
    assert told(few)[2].split() == ["0", "80.00", "–"]


def test_runs_are_read_from_the_campaign_and_those_that_were_stopped_are_not(tmp_path: Path) -> None:
    campaigns: list[tuple[str, str, str, dict[str, str]]] = [
        ("a", "completed", "load sweep, up", {}),  # as runs said it before they had a way
        ("b", "completed", "load sweep, down", {}),
        ("c", "tripped", "load sweep, up", {}),
        ("d", "completed", "wind it down", {"way": "up"}),
        ("e", "completed", "", {"way": "down"}),
    ]
    for name, status, note, campaign in campaigns:
        (tmp_path / name).mkdir()
        about = {
            "schema": "hdrig.run/1",
            "procedure": "kinematic_error",
            "gear": {"ratio": 50},
            "status": status,
            "conditions": {"tau_ext": 2.5, "note": note},
            "campaign": campaign,
        }
        (tmp_path / name / "manifest.json").write_text(json.dumps(about))
        size = {"label": "p-p", "value": 90.0, "unit": "arcsec", "ci95": [89.0, 91.0], "how": ""}
        said = {"schema": "hdrig.result/1", "estimates": {"kinematic_error_peak_to_peak": size}}
        (tmp_path / name / "result.json").write_text(json.dumps(said))
    found = runs_of(tmp_path)
    assert [(run.load, run.peak_to_peak.value) for run, _ in found] == [(2.5, 90.0)] * 4
    assert [down for _, down in found] == [False, True, False, True]
