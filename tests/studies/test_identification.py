"""The study in small: four random rigs, loose bounds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rig.procedures.stiffness_lock import StiffnessLock
from tests.studies import campaign, identification
from tests.studies.campaign import SLOW, STAIRS, MemoryRun, at, random_bench
from tests.studies.identification import Outcome, one, table

PLAN = (SLOW, STAIRS, StiffnessLock(cycles=1, rate=3.0, rates=(1.0,)), at(200.0), at(300.0), at(400.0), at(-300.0))
RIGS = 4
pytestmark = pytest.mark.xdist_group("identification")  # the rigs are made once, not once for every worker


@pytest.fixture(scope="module")
def outcomes() -> list[Outcome]:
    campaign.PLANS["test"] = PLAN
    return [one(n, "test") for n in range(RIGS)]


@pytest.mark.slow
@pytest.mark.long
def test_four_random_rigs_are_found_within_loose_bounds(outcomes: list[Outcome]) -> None:
    bounds = {
        "K": 0.005, "J_l": 0.01, "J_m": 0.02, "B_sp": 0.06, "B_sum": 0.03, "B_l": 0.03, "tau_c": 0.01, "F_cl": 0.01,
    }  # fmt: skip
    for outcome in outcomes:
        assert outcome.failed == ()
        for name, within in bounds.items():
            value, _, true = outcome.figures[name]
            assert value == pytest.approx(true, rel=within), (outcome.rig, name)
        assert abs(outcome.amplitude_error[1]) < 0.2, "C_2, arcsec"


@pytest.mark.slow
@pytest.mark.long
def test_their_intervals_hold_the_truth_about_as_often_as_they_say(outcomes: list[Outcome]) -> None:
    inside = [abs(v - t) <= h for o in outcomes for v, h, t in o.figures.values()]
    series = np.concatenate([np.abs(o.series_error) <= o.series_half for o in outcomes])
    assert np.mean(inside) >= 0.8  # 44 figures that hang together: 95 % less four standard errors
    assert 0.85 <= np.mean(series) <= 0.995  # 120 coefficients


@pytest.mark.slow
@pytest.mark.long
def test_the_table_has_a_line_for_every_parameter_and_a_share_covered(outcomes: list[Outcome]) -> None:
    lines = table(outcomes)
    assert sum(line.startswith("| K ") for line in lines) == 1
    assert all(f"| {RIGS} |" in line for line in lines[2:13])


@pytest.mark.slow
def test_a_rigs_number_is_all_that_makes_it() -> None:
    assert random_bench(3).text == random_bench(3).text
    assert random_bench(3).text != random_bench(4).text


def test_a_study_that_was_stopped_goes_on_from_its_store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[int] = []

    def taken(number: int, plan: str) -> tuple[list[MemoryRun], float, list[str]]:
        made.append(number)
        return [], 0.0, []

    def outcome(number: int, taken: object) -> Outcome:
        none = np.zeros(0)
        return Outcome(number, {}, none, none, none, none, (str(len(made)),), ())

    monkeypatch.setattr(identification, "take", taken)
    monkeypatch.setattr(identification, "random_bench", lambda number: number)
    monkeypatch.setattr(identification, "judged", outcome)
    first = [one(n, "paper", tmp_path) for n in (0, 1)]
    both = [one(n, "paper", tmp_path) for n in (0, 1, 2)]
    assert made == [0, 1, 2], "each rig's runs are made once"
    assert [o.failed for o in both[:2]] == [o.failed for o in first]
    assert one(0, "paper", tmp_path, again=True).failed == ("3",), "identified again, from the runs in the store"
    assert made == [0, 1, 2]
    assert not list(tmp_path.glob("*.part"))
