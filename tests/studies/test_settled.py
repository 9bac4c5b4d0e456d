"""The study of ambiguous cases in small: advice becomes runs of the blind plant, outcomes are judged by the truth."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rig.core.errors import UsageError
from tests.blind import plans
from tests.blind.campaign import reference, staircase
from tests.blind.rig import Rig, draw
from tests.studies import settled
from tests.studies.settled import AMBIGUOUS, Followed, Said, behind, judged, runs_asked_for, study, table

RIG: Rig = draw(np.random.default_rng(3), *plans.PAPERS)
FRICTION = {"speeds_rpm": "15,60,400", "output_deg": 4.0, "breakaways": 1}


def asked(procedure: str, **conditions: Any) -> dict[str, Any]:
    return {"procedure": procedure, "conditions": conditions, "because": "of a test"}


def test_a_speed_is_asked_for_and_made_twice() -> None:
    runs = runs_asked_for(asked("constant_torque", speed_rpm=400.0), RIG)
    assert [run.speed_rpm for run in runs] == [400.0, 400.0]
    assert len({run.name for run in runs}) == 2


def test_a_weight_hangs_where_the_trace_wants_it() -> None:
    runs = runs_asked_for(asked("kinematic_error", tau_ext=-10.0), RIG)
    assert [(run.procedure, run.tau_ext, run.locked) for run in runs] == [("kinematic_error", -10.0, False)] * 2


def test_the_lock_test_winds_the_gear_up_to_the_torques_hdrig_would_take() -> None:
    runs = runs_asked_for(asked("stiffness_lock", output_locked=True), RIG)
    wound = [run.amplitude / RIG.N * RIG.K for run in runs]
    assert wound == pytest.approx([5.0, 5.0, 20.0, 20.0], abs=1e-9)
    assert all(run.locked for run in runs)
    assert len({run.name for run in runs}) == 4


def test_stairs_pass_every_speed_up_and_down_both_ways() -> None:
    run = runs_asked_for(asked("friction", **FRICTION), RIG)[0]
    assert run.stairs_rpm == (15.0, 60.0, 400.0, 400.0, 60.0, 15.0, -15.0, -60.0, -400.0, -400.0, -60.0, -15.0)
    n = round(run.duration_s / 1e-3) + 1
    speed = np.diff(reference(run, n)) / 1e-3 * 30 / np.pi
    ends = [round(plans.STAIR_S * (k + 1) / 1e-3) - 2 for k in range(12)]
    assert speed[ends] == pytest.approx(run.stairs_rpm, rel=1e-9)
    assert np.abs(np.diff(speed)).max() <= 400.0 / 1000 + 1e-9, "reached within a second"
    assert staircase((60.0, -60.0), 8001)[-1] == pytest.approx(np.pi, abs=0.02), (
        "up to speed for 1 s: half a turn less forward"
    )


def test_what_the_blind_plant_cannot_make_is_said() -> None:
    with pytest.raises(UsageError, match="no full-turn"):
        runs_asked_for(asked("full_turn"), RIG)
    with pytest.raises(UsageError, match="cannot run"):
        runs_asked_for(asked("wish"), RIG)


def test_the_run_asked_for_comes_after_all_others() -> None:
    plan = plans.paper_once()
    more = behind(plan, runs_asked_for(asked("constant_torque", speed_rpm=60.0), RIG))
    assert more.runs[: len(plan.runs)] == plan.runs
    times = [(run.start_s, run.start_s + run.lead_s + run.duration_s) for run in more.runs]
    assert all(b[0] >= a[1] for a, b in pairwise(times))


@pytest.mark.parametrize(
    ("status", "effects", "outcome"),
    [
        ("explained", ("quadratic_drag",), "settled"),
        ("explained", ("quadratic_drag", "cogging_torque"), "settled"),
        ("explained", ("stribeck_friction", "quadratic_drag"), "wrong"),
        ("ambiguous", ("quadratic_drag",), "still ambiguous"),
        ("unknown_effect", (), "let go"),
        ("no_missing_effect", (), "let go"),
    ],
)
def test_outcomes(status: str, effects: tuple[str, ...], outcome: str) -> None:
    assert judged("quadratic_drag", Said(status, effects, (), 1.0)) == outcome


def followed(number: int, status: str) -> Followed:
    first = Said(status, ("quadratic_drag",), ("stribeck_friction",) if status == AMBIGUOUS else (), 1.0)
    return Followed(f"case-{number:03d}", "paper", "stribeck_friction/gaussian", 3.0, first, outcome="settled")


def test_a_study_goes_on_from_its_store_until_it_has_its_cases(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[str] = []

    def follow(request: object, folder: Path) -> Followed:
        made.append(folder.name)
        return followed(len(made) - 1, AMBIGUOUS if len(made) % 2 else "explained")

    monkeypatch.setattr(settled, "follow", follow)
    assert len(study(1, 1, tmp_path, 9)) == 1
    found = study(2, 1, tmp_path, 9)
    assert made == ["case-000", "case-001", "case-002"]
    assert [f.first.status for f in found] == [AMBIGUOUS, "explained", AMBIGUOUS]
    assert len(study(9, 1, tmp_path, 4)) == 4, "and no longer than it may"


def test_the_table_counts_ambiguous_cases_alone() -> None:
    rows = [followed(0, AMBIGUOUS), followed(1, "explained"), replace(followed(2, AMBIGUOUS), outcome="wrong")]
    text = "\n".join(table(rows))
    assert "3 campaigns were traced, 2 were called ambiguous" in text
    assert "| settled: explained, the hidden effect first | 1 of 2 = 50%" in text
    assert "Of the other 1, 0 were explained with the hidden effect first, 1 by another" in text
    assert "case-001" not in text
